# SPDX-License-Identifier: Apache-2.0
"""Where a result comes from: what goes into the headers of pictures and the attributes of maps."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from photonloupe import _engine
from photonloupe.device import Device
from photonloupe.errors import PhotonLoupeError
from photonloupe.scene import Scene, load_scene

# Marks our entries among those other programs put into the same header.
_PREFIX = "photonloupe."


def describe_origin(device: Device | None, scene: Scene | None, settings: Mapping[str, Any]) -> dict[str, Any]:
    """Collect version, device, driver, scene and settings of one result."""
    origin: dict[str, Any] = {"version": _engine.version}
    if device is not None:
        info = device.info
        origin["device"] = str(info.get("name", ""))
        origin["driver"] = str(info.get("driver", ""))
    if scene is not None:
        origin["scene_path"] = str(scene.path.absolute())
        origin["scene_hash"] = scene.hash
        if scene.additions:
            origin["scene_additions"] = scene.additions
    origin["settings"] = dict(settings)
    return origin


def list_additions(provenance: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return what was added to the scene's file, as `Scene.restore` takes it.

    Raises
    ------
    PhotonLoupeError
        If it is no list of lights and floors.
    """
    additions = provenance.get("scene_additions", [])
    if not isinstance(additions, list):
        raise PhotonLoupeError("what this map says was added to its scene is no list of lights and floors")
    return additions


def reload_scene(provenance: Mapping[str, Any]) -> Scene:
    """Load the scene that a map was traced in once more.

    Raises
    ------
    PhotonLoupeError
        If the provenance names none, or its file is gone or has changed.
    """
    path = provenance.get("scene_path")
    if not path:
        raise PhotonLoupeError("this map knows of no scene")
    scene = load_scene(path)
    scene.restore(list_additions(provenance))
    if scene.hash != provenance.get("scene_hash"):
        raise PhotonLoupeError(
            f"{path} has changed since this map was made; trace it anew (its photons as they are can still be relaxed "
            'in their tangent planes, surface="tangent")'
        )
    return scene


def encode_attributes(provenance: Mapping[str, Any]) -> dict[str, str]:
    """Turn a provenance into the text attributes of an EXR or PNG file."""
    return {
        _PREFIX + name: value if isinstance(value, str) else json.dumps(value, sort_keys=True)
        for name, value in provenance.items()
    }


def decode_attributes(attributes: Mapping[str, str]) -> dict[str, Any]:
    """Undo `encode_attributes`, leaving out what other programs wrote."""
    provenance: dict[str, Any] = {}
    for name, text in attributes.items():
        if not name.startswith(_PREFIX):
            continue
        value: Any = text
        if text[:1] in "{[":
            try:
                value = json.loads(text)
            except ValueError:
                value = text
        provenance[name.removeprefix(_PREFIX)] = value
    return provenance
