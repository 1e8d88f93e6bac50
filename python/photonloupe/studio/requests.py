# SPDX-License-Identifier: Apache-2.0
"""Files the studio opens, saves and watches."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from photonloupe import _engine
from photonloupe.errors import ArgumentError, PhotonLoupeError
from photonloupe.inspect.parallel_axes import Axis
from photonloupe.inspect.parallel_coordinates import parallel_coordinates
from photonloupe.scene import Scene, load_scene
from photonloupe.scripting import Script, compile_script
from photonloupe.studio.results import Results

SCENES = (".gltf", ".glb")
SCRIPT = ".photon"
MAP = ".zarr"
SESSION = ".loupe"
IMAGES = (".exr", ".png")
_DEFAULT_SESSION = "session.loupe"
_LARGEST_SCRIPT = 1 << 20
# Of a file that is not there.
_GONE = (0, -1)


class Requests:
    """Serves what the interface asks for beside its work, and notices files that changed."""

    def __init__(
        self, native: _engine.Studio, results: Results, export: Callable[[], Callable[..., None] | None]
    ) -> None:
        self._native = native
        self._export = export
        self._results = results
        self._session = ""
        self._stamps: dict[str, tuple[int, int]] = {}

    def serve(self) -> bool:
        """Serve all that waits; True: something was."""
        waiting = self._native.take_requests()
        for request in waiting:
            verb, _, argument = request.partition(" ")
            try:
                self._serve(verb, argument.strip())
            except (PhotonLoupeError, OSError, ValueError) as error:
                self._native.say(describe_error(error), True)
        return bool(waiting)

    def _serve(self, verb: str, argument: str) -> None:
        if verb == "cancel":
            self._native.stop_job()
        elif verb == "open":
            self.open_file(argument)
        elif verb == "save_script":
            self._save_script(argument)
        elif verb == "save_session":
            self.save_session(argument or self._session or _find_free_name(_DEFAULT_SESSION))
        elif verb == "store_reference":
            self._store_reference()
        elif verb == "export":
            asked = json.loads(argument)
            if not asked["path"]:
                raise ArgumentError("name a file to write the figure to")
            export = self._export()
            if export is not None:
                export(asked["panel"], asked["path"], asked["size"], asked["scale"])
            self._native.say(f"wrote {asked['path']}", False)
        elif verb in ("restore", "discard"):
            if verb == "restore":
                self._native.load_session(argument)
            Path(argument).unlink(missing_ok=True)

    def open_file(self, path: str) -> None:
        """Open a scene, map, script, session or reference image, by its suffix."""
        if not path:
            raise ArgumentError("name a file to open")
        suffix = Path(path).suffix.lower()
        if suffix in SCENES:
            self.open_scene(path, None)
        elif suffix == SCRIPT:
            self.open_script(Path(path), runs=False)
        elif suffix == SESSION:
            self._native.load_session(path)
            self._session = path
        elif suffix in IMAGES:
            self._change("reference", {"image": {"reference": str(Path(path).absolute())}})
        elif suffix == MAP or Path(path).is_dir():
            if not Path(path).exists():
                raise ArgumentError(f"{path}: there is no such photon map")
            self._change("open map", {"trace": {"map": str(Path(path).absolute()), "scene": "", "additions": []}})
        else:
            kinds = ", ".join((*SCENES, SCRIPT, MAP, SESSION, *IMAGES))
            raise ArgumentError(f"{path} is none of the files the studio opens: {kinds}")

    def open_scene(self, scene: Scene | str | os.PathLike[str], photons: int | None) -> None:
        """Open a scene and trace it."""
        path = str(Path(scene.path if isinstance(scene, Scene) else scene).absolute())
        # What is wrong with it is said before the old one goes.
        self._native.open_scene((scene if isinstance(scene, Scene) else load_scene(path))._native)
        self._native.forget_work("trace")  # the file may have changed
        trace: dict[str, Any] = {"scene": path, "map": ""}
        is_other = path != json.loads(self._native.state())["trace"]["scene"]
        if isinstance(scene, Scene) or is_other:
            trace["additions"] = list(scene._native.additions) if isinstance(scene, Scene) else []
        if photons is not None:
            trace["photons"] = photons
        change: dict[str, dict[str, Any]] = {"trace": trace}
        if is_other:
            change["view"] = {"camera": {"is_set": False}}
        self._change("open scene", change)
        self._watch(path)

    def open_script(self, script: str | os.PathLike[str] | Script, *, runs: bool) -> None:
        """Take a script into the editor, and run it."""
        path = ""
        if isinstance(script, Script):
            text = script.text
        elif isinstance(script, os.PathLike) or (script.endswith(SCRIPT) and "\n" not in script):
            path = str(Path(script).absolute())
            text = _read_script(Path(path))
            self._watch(path)
        else:
            text = script
        change: dict[str, Any] = {"path": path, "text": text, "values": {}}
        if runs:
            compile_script(Script(text.encode("utf-8", "surrogatepass"), path or "script")).require()
            change["ran"] = text
        self._change("open script", {"script": change})

    def save_session(self, path: str) -> None:
        """Write the session and remember where."""
        self._native.save_session(path)
        self._session = path
        self._native.say(f"saved {path}", False)

    def write_svg(self, name: str, path: str | os.PathLike[str], size: tuple[int, int]) -> None:
        """Write the parallel coordinates as they are chosen as an SVG file."""
        if name != "Parallel coordinates":
            raise ArgumentError(f"only parallel coordinates are written as SVG; export {name} as .png")
        whole = json.loads(self._native.complete_state())
        state = whole["parallel"]
        shows_relaxed = whole["view"]["shows_relaxed"] and self._native.has_relaxed()
        photons = self._results.relaxed if shows_relaxed else self._results.photons
        if photons is None or not state["axes"]:
            raise ArgumentError("there is nothing to plot yet; open a scene and draw a frame")
        axes = [
            Axis(
                axis["name"],
                low=None if axis["low"] == axis["high"] else axis["low"],
                high=None if axis["low"] == axis["high"] else axis["high"],
                closed=axis["is_closed"],
                periods=axis["periods"],
                flipped=axis["is_flipped"],
                brush=[tuple(brush) for brush in axis["brushes"]],
            )
            for axis in state["axes"]
        ]
        ids = self._native.loupe_ids() if state["source"] == "loupe" else None
        plot = parallel_coordinates(photons, axes, selection=ids, size=size, tension=state["tension"])
        plot.save_svg(path)

    def watch_files(self) -> bool:
        """Open files again that changed on the disk; what is wrong with one leaves the last good state.

        True: there was a change.
        """
        changed = False
        for path in self._native.paths():
            if path and path not in self._stamps:
                self._watch(path)  # of a session, an example or an undo
        for path, stamp in list(self._stamps.items()):
            now = _find_stamp(path)
            if now in (stamp, _GONE):
                continue
            self._stamps[path] = now
            scene, script = self._native.paths()
            try:
                if path == script:
                    self.open_script(Path(path), runs=True)
                elif path == scene:
                    self.open_scene(path, None)
            except (PhotonLoupeError, OSError) as error:
                self._native.say(f"changed on the disk: {describe_error(error)}", True)
            changed = True
        return changed

    def _watch(self, path: str) -> None:
        self._stamps[path] = _find_stamp(path)

    def _change(self, name: str, parts: dict[str, dict[str, Any]]) -> None:
        """Change some fields of the state, as one command."""
        state = json.loads(self._native.state())
        for part, fields in parts.items():
            _merge(state[part], fields)
        self._native.set_state(name, json.dumps(state))

    def _save_script(self, path: str) -> None:
        state = json.loads(self._native.state())
        path = path or state["script"]["path"]
        if not path:
            raise ArgumentError("name a file to save the script to")
        if Path(path).suffix != SCRIPT:
            raise ArgumentError(f"{path}: scripts are {SCRIPT} files")
        _engine.write_file(path, state["script"]["text"].encode("utf-8"))
        self._change("save script", {"script": {"path": str(Path(path).absolute())}})
        self._watch(str(Path(path).absolute()))
        self._native.say(f"saved {path}", False)

    def _store_reference(self) -> None:
        image = self._results.image
        if image is None:
            raise ArgumentError("there is no picture to store yet; it is being rendered")
        path = Path(_find_free_name("reference.exr")).absolute()
        image.save(path)
        self._change("store reference", {"image": {"reference": str(path)}})


def describe_error(error: BaseException) -> str:
    """Say in one line what went wrong."""
    if isinstance(error, OSError):
        return f"{error.filename or 'a file'}: {error.strerror or os.strerror(error.errno or 0)}"
    return " ".join(str(error).split()) or type(error).__name__


def _find_free_name(name: str) -> str:
    """Return the name, or with a number the first that no file has: nothing is overwritten unasked."""
    wanted = Path(name)
    number = 1
    path = wanted
    while path.exists():
        number += 1
        path = wanted.with_stem(f"{wanted.stem}-{number}")
    return str(path)


def _merge(target: dict[str, Any], fields: dict[str, Any]) -> None:
    for name, value in fields.items():
        if isinstance(value, dict) and isinstance(target.get(name), dict) and value:
            _merge(target[name], value)
        else:
            target[name] = value


def _read_script(path: Path) -> str:
    if path.stat().st_size > _LARGEST_SCRIPT:
        raise ArgumentError(f"{path} is larger than any script")
    return path.read_text(encoding="utf-8", errors="replace")


def _find_stamp(path: str) -> tuple[int, int]:
    try:
        found = Path(path).stat()
    except (OSError, ValueError):
        return _GONE
    return found.st_mtime_ns, found.st_size
