# SPDX-License-Identifier: Apache-2.0
"""The studio's work: each stage by the public calls, so that what is shown is what Python gives."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from photonloupe import _engine
from photonloupe.camera import Camera
from photonloupe.columns import PATH_NAMES
from photonloupe.device import Device
from photonloupe.errors import ArgumentError, Cancelled, PhotonLoupeError
from photonloupe.image import Image, load_image
from photonloupe.inspect.error_map import error_map
from photonloupe.isotropy import optimal_beta
from photonloupe.loading import load_photons
from photonloupe.metrics import compare_images
from photonloupe.photons import PhotonMap
from photonloupe.relaxing import Relaxation
from photonloupe.rendering import render
from photonloupe.scene import Scene, load_scene
from photonloupe.scripting import Histogram, Script, ScriptRun
from photonloupe.studio.spread import MANY, SAMPLE, measure_spread
from photonloupe.tracing import trace_photons

Progress = Callable[[str, float], bool]

# Pixels of rendered views, as the engine's python_script.h has them.
RENDER_SIZE = (640, 480)
_MILLISECONDS = 1000.0


class Stages:
    """Scene, photons, relaxation and images of a studio; one thread uses it.

    Photons that the interface shows are never changed: a script runs over others in the same memory.
    """

    def __init__(self, device: Device, native: _engine.Studio) -> None:
        self._device = device
        self._native = native
        self.scene: Scene | None = None
        self.traced: PhotonMap | None = None
        self.photons: PhotonMap | None = None  # with what the script gave them
        self.relaxed: PhotonMap | None = None
        self.image: Image | None = None
        self._opened: Scene | None = None  # takes the scene's place with the next trace
        self._relaxation: Relaxation[PhotonMap] | None = None
        self._relaxation_key = ""
        self._rows: list[tuple[float, float, float, float]] = []
        self._milliseconds: dict[str, float] = {}

    def open_scene(self, scene: Scene) -> None:
        """Take a scene's place when photons are traced next; from any thread."""
        self._opened = scene

    def run(self, kind: str, settings: dict[str, Any], progress: Progress) -> None:
        """Do one job and hand its result to the interface."""
        start = time.perf_counter()
        stages: dict[str, Callable[[dict[str, Any], Progress], None]] = {
            "trace": self._trace,
            "map": self._load_map,
            "script": self._run_script,
            "relax": self._relax,
            "isotropy": self._measure_isotropy,
            "render": self._render,
            "reference": self._compare,
        }
        stages[kind](settings, progress)
        self._milliseconds[kind] = _MILLISECONDS * (time.perf_counter() - start)
        self._native.deliver_times(self._milliseconds)

    def _trace(self, settings: dict[str, Any], progress: Progress) -> None:
        path = settings["scene"]
        opened, self._opened = self._opened, None
        self.scene = opened or self.scene
        if self.scene is None or str(Path(self.scene.path).absolute()) != path:
            self.scene = load_scene(path)
        photons = trace_photons(
            self.scene,
            columns=PATH_NAMES,
            device=self._device,
            progress=progress,
            **settings["settings"],
        )
        self._take_photons(photons)

    def _load_map(self, settings: dict[str, Any], progress: Progress) -> None:
        photons = load_photons(settings["map"], device=self._device)
        try:
            self.scene = photons.find_surface()
        except PhotonLoupeError as error:
            self.scene = None
            self._native.say(f"without its scene: {error}", False)
        self._take_photons(photons)

    def _take_photons(self, photons: PhotonMap) -> None:
        if len(photons) == 0:
            raise ArgumentError("there are no photons to look at; trace more, or another store")
        try:
            photons.record_paths()
        except PhotonLoupeError as error:
            self._native.say(f"without paths: {error}", False)
        self.traced = photons
        self._show(photons, has_same_paths=False)

    def _show(self, photons: PhotonMap, *, has_same_paths: bool) -> None:
        """Let the interface show photons."""
        self.photons = photons
        self.relaxed = None
        self._relaxation = None
        self._relaxation_key = ""
        scene = None if self.scene is None else self.scene._native
        self._native.deliver_photons(scene, photons._native, has_same_paths)

    def _run_script(self, settings: dict[str, Any], progress: Progress) -> None:
        if self.traced is None:
            raise PhotonLoupeError("there are no photons to run the script over; open a scene")
        if not settings["text"]:
            if self.photons is not self.traced:
                self._native.forget_script()
                self._show(self.traced, has_same_paths=True)
            return
        script = _make_script(settings)
        values = {name: value for name, value in settings["values"].items() if name in _list_exposed(script)}
        target = self.traced.share()
        start = time.perf_counter()
        run = target.run_script(script, values=values, progress=progress)
        milliseconds = _MILLISECONDS * (time.perf_counter() - start)
        self._native.deliver_script(
            [_describe_histogram(name, histogram) for name, histogram in run.histograms.items()],
            list(run.prints),
            _describe_report(run),
            milliseconds,
        )
        self._show(target, has_same_paths=True)

    def _relax(self, settings: dict[str, Any], progress: Progress) -> None:
        assert self.photons is not None
        made, key = settings["made"], settings["settings_key"]
        if self._relaxation is None or key != self._relaxation_key or self._relaxation.step_count > made:
            self._relaxation = Relaxation(self.photons, progress=progress, **settings["settings"])
            self._relaxation_key = key
            self._rows = []
        relaxation = self._relaxation
        try:
            while relaxation.step_count < made:
                row = relaxation.step(progress=progress)
                low_frequency, noise = measure_spread(relaxation.sample_distances(SAMPLE, MANY + 1))
                self._rows.append((row["mean_displacement"], row["mean_move"], low_frequency, noise))
                self._native.deliver_steps(self._rows)
                if not progress("relax", relaxation.step_count / made):
                    raise Cancelled("stopped on request")
        except Cancelled:
            self._show_relaxed(relaxation, stopped_at=relaxation.step_count)
            raise
        self._show_relaxed(relaxation, stopped_at=None)

    def _show_relaxed(self, relaxation: Relaxation[PhotonMap], *, stopped_at: int | None) -> None:
        """Let the interface show the photons as far as they are relaxed; stopped half way, those steps stay."""
        self.relaxed = relaxation.photons
        self._native.deliver_relaxed(self.relaxed._native, self._rows, stopped_at)

    def _measure_isotropy(self, settings: dict[str, Any], progress: Progress) -> None:
        assert self.photons is not None
        beta = optimal_beta(self.photons, progress=progress)
        self._native.deliver_isotropy(np.ascontiguousarray(beta.isotropy.values), float(beta), beta.t_beta)
        self._native.say(f"β = {float(beta):.4g} from t_β = {beta.t_beta:.4g}", False)

    def _find_shown(self, settings: dict[str, Any]) -> PhotonMap:
        assert self.photons is not None
        return self.relaxed if settings["relaxed"] and self.relaxed is not None else self.photons

    def _render(self, settings: dict[str, Any], progress: Progress) -> None:
        if self.scene is None:
            raise PhotonLoupeError("rendering needs the scene the photons were traced in; open it")
        photons = self._find_shown(settings)
        camera = settings["camera"]
        looks = Camera(camera["position"], camera["target"], camera["up"], camera["yfov"])
        common: dict[str, Any] = {
            "camera": looks,
            "width": RENDER_SIZE[0],
            "height": RENDER_SIZE[1],
            "device": self._device,
            "progress": progress,
            **settings["settings"],
        }
        self.image = render(self.scene, photons, **common)
        colors = None
        if "colors" in photons.recorded:
            colors = np.ascontiguousarray(render(self.scene, photons, mode="false-color", **common))
        self._native.deliver_images(np.ascontiguousarray(self.image), colors)

    def _compare(self, settings: dict[str, Any], progress: Progress) -> None:
        if self.image is None:
            return
        reference = load_image(settings["path"])
        try:
            difference = compare_images(self.image, reference)
        except PhotonLoupeError:
            self._native.deliver_comparison(np.ascontiguousarray(reference), None, 0.0, 0.0, 0.0)
            raise
        error = error_map(self.image, reference).image
        self._native.deliver_comparison(
            np.ascontiguousarray(reference),
            np.ascontiguousarray(error),
            difference.rmse,
            difference.relmse,
            difference.flip,
        )


def _make_script(settings: dict[str, Any]) -> Script:
    name = Path(settings["path"]).name or "script"
    return Script(settings["text"].encode("utf-8", "surrogatepass"), name)


def _list_exposed(script: Script) -> set[str]:
    return {variable.name for variable in script.exposed}


def _describe_histogram(name: str, histogram: Histogram) -> dict[str, Any]:
    return {
        "name": name,
        "low": float(histogram.edges[0]),
        "high": float(histogram.edges[-1]),
        "counts": [float(count) for count in histogram.counts],
    }


def _describe_report(run: ScriptRun) -> list[str]:
    lines = [
        f"line {row['line']}: {row['kind']} loop" + (f", stopped: {row['stopped']}" if row["stopped"] else "")
        for row in run.report["passes"]
    ]
    for row in run.report["faults"]:
        first = "" if row["first_photon"] is None else f" first at photon {row['first_photon']}"
        lines.append(f"line {row['line']}: {row['what']}, {row['count']} photons{first}")
    for name, row in run.report["parameters"].items():
        for what in ("unset", "out_of_bounds", "non_finite"):
            if row[what]["count"]:
                lines.append(f"{name}: {row[what]['count']} photons {what.replace('_', ' ')}")
    if run.report["stopped"]:
        lines.append(f"stopped: {run.report['stopped']}")
    return lines


def read_job(settings: str) -> dict[str, Any]:
    """Turn a job's JSON into keywords."""
    return dict(json.loads(settings))


def describe_error(error: BaseException) -> str:
    """Say in one line what went wrong."""
    if isinstance(error, Cancelled):
        return "stopped on request; what was there stays"
    if isinstance(error, OSError):
        return f"{error.filename or 'a file'}: {error.strerror or os.strerror(error.errno or 0)}"
    return " ".join(str(error).split()) or type(error).__name__
