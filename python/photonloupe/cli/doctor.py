# SPDX-License-Identifier: Apache-2.0
"""``photonloupe doctor``: everything a bug report needs, and whether this machine can do the work."""

from __future__ import annotations

import argparse
import importlib.metadata
import platform
from typing import Any

import photonloupe as pl
from photonloupe.cli.common import EXIT_NO_DEVICE, EXIT_OK, add_device_option, format_table, print_result

SUMMARY = "versions, devices, a self-test; with a scene: what it requires"
DESCRIPTION = "Print versions, the Vulkan devices and which was chosen and why, run one test dispatch; describe SCENE."

_PACKAGES = ("numpy", "zarr", "pyarrow", "pillow", "flip-evaluator", "tqdm")
_MEBIBYTE = 1 << 20


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    parser.add_argument("scene", metavar="SCENE", nargs="?", help=".gltf or .glb")
    add_device_option(parser)


def _find_versions() -> dict[str, str]:
    versions = {
        "photonloupe": pl.__version__,
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
    }
    for package in _PACKAGES:
        try:
            versions[package] = importlib.metadata.version(package)
        except importlib.metadata.PackageNotFoundError:
            versions[package] = "not installed"
    return versions


def _examine_devices(selector: str) -> dict[str, Any]:
    """List the devices, open one and try it; an error becomes part of the findings."""
    findings: dict[str, Any] = {"devices": [], "chosen": None, "self_test": None, "device_error": None}
    try:
        findings["devices"] = pl.devices()
        device = pl.Device(selector)
        findings["chosen"] = device.info
        findings["self_test"] = device.self_test()
        if not findings["self_test"].get("ok"):
            findings["device_error"] = "the self-test gave a wrong result; this driver cannot be trusted"
    except pl.DeviceError as error:
        findings["device_error"] = str(error)
    return findings


def _describe_scene(path: str) -> dict[str, Any]:
    scene = pl.load_scene(path)
    return {"path": scene.path, "hash": scene.hash, "report": scene.report, "text": scene.describe()}


def _format(findings: dict[str, Any]) -> list[str]:
    lines = [f"{name} {version}" for name, version in findings["versions"].items()]
    if findings["devices"]:
        rows = [["", "index", "device", "type", "driver", "Vulkan", "MiB", "usable"]]
        chosen = findings["chosen"] or {}
        for entry in findings["devices"]:
            mark = "*" if entry.get("index") == chosen.get("index") else ""
            told = [str(entry.get(name)) for name in ("index", "name", "type", "driver", "api_version")]
            usable = "yes" if entry.get("usable") else f"no: {entry.get('reason')}"
            rows.append([mark, *told, f"{int(entry.get('memory', 0)) // _MEBIBYTE:,}", usable])
        lines += ["", *format_table(rows)]
    if findings["chosen"]:
        lines.append(f"chosen: {findings['chosen'].get('chosen_because', 'the first usable one')}")
    test = findings["self_test"]
    if test:
        lines.append(f"self-test: {'passed' if test.get('ok') else 'FAILED'} in {test.get('milliseconds', 0.0):.1f} ms")
    if findings["device_error"]:
        lines.append(f"no usable device: {findings['device_error']}")
    if findings.get("scene"):
        lines += ["", findings["scene"]["text"]]
    return lines


def run(arguments: argparse.Namespace) -> int:
    """Run the verb."""
    findings: dict[str, Any] = {"versions": _find_versions(), **_examine_devices(arguments.device)}
    if arguments.scene:
        findings["scene"] = _describe_scene(arguments.scene)
    print_result(arguments, findings, lambda: _format(findings))
    return EXIT_NO_DEVICE if findings["device_error"] else EXIT_OK
