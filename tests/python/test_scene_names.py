# SPDX-License-Identifier: Apache-2.0
"""Messages and maps call a scene file what its user called it."""

from __future__ import annotations

from pathlib import Path

import pytest

import photonloupe as pl

NAMES = ["a b.gltf", 'ä [x] "q" %20#?.gltf', "-o.gltf", "sub/../plain.gltf", "./dotted.gltf", "{braces}.gltf"]


@pytest.mark.parametrize("name", NAMES)
def test_a_refused_file_is_called_what_its_user_called_it(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sub").mkdir()
    Path(name).write_text("{}", encoding="utf-8")
    with pytest.raises(pl.SceneError) as refusal:
        pl.load_scene(name)
    assert str(refusal.value).startswith(f'{name}: "asset" is missing')


@pytest.mark.parametrize("name", NAMES)
def test_a_loaded_file_keeps_its_name(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sub").mkdir()
    Path(name).write_text('{"asset": {"version": "2.0"}}', encoding="utf-8")
    assert str(pl.load_scene(name).path) == str(Path(name))


def test_a_name_that_is_no_utf_8_is_refused(tmp_path: Path) -> None:
    with pytest.raises(pl.SceneError, match="its name is no UTF-8"):
        pl.load_scene(tmp_path / "bad\udcff.gltf")
