# SPDX-License-Identifier: Apache-2.0
"""Real glTF files from packages of npm and PyPI: fetched, loaded, lit, traced and rendered.

`./photonloupe python tests/corpus/corpus.py` writes docs/robustness.md; the files stay in build/corpus.
"""

from __future__ import annotations

import base64
import hashlib
import json
import re
import shutil
import subprocess
import sys
import tarfile
import time
import zipfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

import photonloupe as pl

ROOT = Path(__file__).resolve().parents[2]
DOCUMENT = ROOT / "docs" / "robustness.md"
FOLDER = ROOT / "build" / "corpus"
# Registry, package, version, sha256 of its archive, and the files in it.
PACKAGES: list[dict[str, Any]] = json.loads(Path(__file__).with_name("packages.json").read_text(encoding="utf-8"))
# What glTF files need beside them.
NEEDED = {".gltf", ".glb", ".bin", ".png", ".jpg", ".jpeg", ".webp", ".ktx2"}
# A module of JavaScript that holds a GLB as a data URI.
SCRIPT = ".js"

PHOTONS = 20_000
WIDTH, HEIGHT = 64, 48

HEADER = """# Real files

Written by `./photonloupe python tests/corpus/corpus.py` on the software device. Every file below is fetched from its
package ([tests/corpus/packages.json](../tests/corpus/packages.json)), loaded, given `--light auto` where it has no
light, traced with {photons:,} photons, and rendered at {width} × {height}. What no photon would stay on, all of it
metal or out of the light's reach, gets a floor; what its own lamps leave black, a light. A picture counts that is
finite and not black; nobody compared it with another renderer's. `pytest tests/corpus` runs the same as tests.

{count} files: {loaded} load, {rendered} render.

| file | triangles | loads | added | renders | seconds | ignored |
|---|---|---|---|---|---|---|
"""


@dataclass
class Result:
    """What became of a file."""

    triangles: int = 0
    loaded: str = "no"
    added: list[str] = field(default_factory=list)
    rendered: str = "no"
    seconds: float = 0.0
    ignored: list[str] = field(default_factory=list)


def list_files() -> list[str]:
    """Every file as `package/path`."""
    return [f"{package['name']}/{name}" for package in PACKAGES for name in package["files"]]


def download(package: dict[str, Any], folder: Path) -> Path:
    """Ask the registry's own client for the archive; refuse one that is another than was listed."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    name, version = package["name"], package["version"]
    if package["registry"] == "npm":
        command = ["npm", "pack", "--silent", f"{name}@{version}"]
    else:
        options = ["--quiet", "--no-deps", "--only-binary", ":all:"]
        command = [sys.executable, "-m", "pip", "download", *options, f"{name}=={version}"]
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    archive = next(folder.iterdir())
    found = hashlib.sha256(archive.read_bytes()).hexdigest()
    if found != package["sha256"]:
        raise ValueError(f"{archive.name} has the hash {found}, packages.json says {package['sha256']}")
    return archive


def extract(archive: Path, folder: Path) -> None:
    """Unpack what scenes consist of."""
    if archive.suffix == ".whl":
        with zipfile.ZipFile(archive) as whole:
            whole.extractall(folder, [name for name in whole.namelist() if Path(name).suffix.lower() in NEEDED])
        return
    with tarfile.open(archive) as whole:
        kept = [each for each in whole if each.isfile() and Path(each.name).suffix.lower() in NEEDED | {SCRIPT}]
        whole.extractall(folder, kept)  # its hash was checked: these are the names that were listed


def fetch(package: dict[str, Any]) -> Path:
    """Folder of a package's files, fetched unless they are there."""
    folder = FOLDER / package["sha256"]
    if not folder.is_dir():
        staging = folder.with_suffix(".part")
        archive = download(package, staging)
        extract(archive, staging)
        archive.unlink()
        staging.rename(folder)
    return folder


def find_file(name: str) -> Path:
    """Path of one of `list_files`."""
    package = next(each for each in PACKAGES if name.startswith(each["name"] + "/"))
    path = fetch(package) / name.removeprefix(package["name"] + "/")
    if path.suffix == SCRIPT:
        embedded = re.search(rb"base64,([A-Za-z0-9+/=]+)", path.read_bytes())
        assert embedded, f"{name} embeds nothing"
        path = path.with_suffix("")
        path.write_bytes(base64.b64decode(embedded[1]))
    return path


def summarize(ignored: list[str]) -> list[str]:
    """What is ignored, without where."""
    kinds = (re.sub(r'^(material "[^"]*"|/\S+): ', "", re.sub(r" \(\d+\)", "", line)) for line in ignored)
    return sorted({kind.removesuffix(": not modeled") for kind in kinds})


def trace(scene: pl.Scene, result: Result) -> pl.PhotonMap:
    """Trace photons, with a light and a floor where there is nothing that sends or keeps them."""
    if not scene.lights:
        scene.add_light("auto")
        result.added.append("light")
    try:
        return pl.trace_photons(scene, PHOTONS, seed=1, store="all")
    except pl.SceneError:
        scene.add_floor()
        result.added.append("floor")
        return pl.trace_photons(scene, PHOTONS, seed=1, store="all")


def render(scene: pl.Scene, result: Result) -> np.ndarray:
    """Picture of the scene by its own camera, or one that fits."""
    photons = trace(scene, result)
    return np.asarray(pl.render(scene, photons, width=WIDTH, height=HEIGHT, samples=1))


def run_file(name: str) -> Result:
    """Load, light, trace and render a file; a refusal is part of the result."""
    path = find_file(name)
    result = Result()
    start = time.monotonic()
    try:
        scene = pl.load_scene(path)
        result.loaded, result.triangles = "yes", scene.triangle_count
        result.ignored = summarize(scene.report["ignored"])
        image = render(scene, result)
        if image.max() == 0 and not result.added:  # its own lamps shine away from what the camera sees
            scene.add_light("auto")
            result.added.append("light")
            image = render(scene, result)
        if not np.isfinite(image).all():
            result.rendered = "NaN"
        else:
            result.rendered = "yes" if image.max() > 0 else "black"
    except pl.PhotonLoupeError as error:
        message = str(error).replace(str(path), name)
        if result.loaded == "yes":
            result.rendered = message
        else:
            result.loaded = message
    result.seconds = time.monotonic() - start
    return result


def write_document() -> None:
    """Run every file and write the table."""
    results: dict[str, Result] = {}
    for name in list_files():
        results[name] = run_file(name)
        print(f"{results[name].seconds:6.2f} s  {name}: {results[name].loaded}, {results[name].rendered}", flush=True)
    header = HEADER.format(
        photons=PHOTONS,
        width=WIDTH,
        height=HEIGHT,
        count=len(results),
        loaded=sum(each.loaded == "yes" for each in results.values()),
        rendered=sum(each.rendered == "yes" for each in results.values()),
    )
    rows = [
        f"| {name} | {each.triangles:,} | {each.loaded} | {' and '.join(each.added)} | {each.rendered} | "
        f"{each.seconds:.1f} | {'; '.join(each.ignored) or 'nothing'} |\n"
        for name, each in results.items()
    ]
    packages = "".join(f"- {each['registry']}: {each['name']} {each['version']}\n" for each in PACKAGES)
    DOCUMENT.write_text(header + "".join(rows) + "\n## Packages\n\n" + packages, encoding="utf-8")


if __name__ == "__main__":
    write_document()
