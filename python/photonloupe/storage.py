# SPDX-License-Identifier: Apache-2.0
"""Writes photon maps as Zarr v3 folders and reads them back, trusting nothing in them."""

from __future__ import annotations

import json
import math
import os
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from photonloupe.atomic import find_whole, make_sibling, replace_folder
from photonloupe.columns import (
    ALL_COLUMNS,
    MAX_PHOTONS,
    PHOTON_COLUMNS,
    STATE_COLUMNS,
    Column,
    Columns,
    check_columns,
    check_state,
)
from photonloupe.errors import ArgumentError, FileFormatError
from photonloupe.parameters import MAX_PARAMETERS

FORMAT = 1
_FORMAT_KEY = "photonloupe_format"
_META_KEYS = {"emitted": int, "settings": dict, "report": dict, "provenance": dict}
_OPTIONAL_META_KEYS = {"parameters": list, "relaxation": dict}
# 131,072 rows of three floats are 1.5 MB: large enough for the disk, small enough to stream.
CHUNK_ROWS = 1 << 17
# A path has at most 64 bounces, so 66 vertices.
_MAX_VERTICES = MAX_PHOTONS * 66
_MAX_METADATA_BYTES = 1 << 20
_CODECS = {"bytes", "zstd", "crc32c"}


def check_map_path(path: str | os.PathLike[str]) -> Path:
    """Return where a map would be written, or raise if it cannot be: asked before long work begins."""
    target = Path(path).absolute()
    if target.is_symlink():
        target = target.resolve()
    if target.exists() and not _is_map(target):
        raise FileFormatError(f"{path} is there already and is not a photon map; choose another name")
    if not target.parent.is_dir():
        raise FileFormatError(f"{target.parent} is not a folder; make it first")
    return target


def write_map(path: str | os.PathLike[str], columns: Columns, meta: Mapping[str, Any]) -> None:
    """Write the columns and what describes them; see `PhotonMap.save`."""
    target = check_map_path(path)
    try:
        fresh = make_sibling(target)
        try:
            _write_group(fresh, columns, meta)
            replace_folder(fresh, target)
        finally:
            shutil.rmtree(fresh, ignore_errors=True)
    except OSError as error:
        raise FileFormatError(f"{path} cannot be written: {error.strerror or error}") from error


def _write_group(folder: Path, columns: Columns, meta: Mapping[str, Any]) -> None:
    import zarr  # noqa: PLC0415 - imported at first use: `import photonloupe` stays quick
    from zarr.codecs import Crc32cCodec, ZstdCodec  # noqa: PLC0415

    attributes = {_FORMAT_KEY: FORMAT, **{key: meta[key] for key in (*_META_KEYS, *_OPTIONAL_META_KEYS) if key in meta}}
    group = zarr.create_group(store=folder, zarr_format=3, attributes=attributes, overwrite=True)
    for name, values in columns.items():
        array = group.create_array(
            name,
            shape=values.shape,
            # By name: C's `unsigned long long` is a uint64 that Zarr does not know.
            dtype=np.dtype(ALL_COLUMNS[name].dtype),
            chunks=(CHUNK_ROWS, *values.shape[1:]),
            compressors=[ZstdCodec(level=1), Crc32cCodec()],
            # A chunk that is not there then always means damage, never zeros.
            config={"write_empty_chunks": True},
        )
        if len(values):
            array[...] = values


def read_map(path: str | os.PathLike[str]) -> tuple[Columns, dict[str, Any]]:
    """Read the columns and what describes them; see `load_photons`."""
    folder = find_whole(Path(path))
    if not folder.is_dir():
        raise FileFormatError(f"{path} is not there, or is not a folder")
    if not _is_map(folder):
        raise FileFormatError(f"{path} is not a photon map: its zarr.json does not say so")
    _refuse_links(folder)
    meta = _read_meta(folder)
    names = [name for name in ALL_COLUMNS if (folder / name).is_dir()]
    for column in PHOTON_COLUMNS:
        if column.name not in names:
            raise FileFormatError(f"{path} lacks the array {column.name}; save the map again")
    arrays = {name: _read_array(folder / name, ALL_COLUMNS[name]) for name in names}
    state = {column.name: arrays.pop(column.name) for column in STATE_COLUMNS if column.name in arrays}
    try:
        columns = check_columns(arrays)
        for name, values in state.items():
            columns[name] = check_state(name, values, len(columns["positions"]))
        return columns, meta
    except ArgumentError as error:
        raise FileFormatError(f"{path} holds no valid photon map: {error}") from error


def _read_json(path: Path) -> dict[str, Any]:
    try:
        if path.stat().st_size > _MAX_METADATA_BYTES:
            raise FileFormatError(f"{path} is larger than any description of an array")
        document = json.loads(path.read_bytes())
    except (OSError, ValueError, RecursionError) as error:
        raise FileFormatError(f"{path} is missing or is not JSON; save the map again") from error
    if not isinstance(document, dict):
        raise FileFormatError(f"{path} is not a description of an array or group")
    return document


def _is_map(folder: Path) -> bool:
    try:
        attributes = _read_json(folder / "zarr.json").get("attributes")
    except FileFormatError:
        return False
    return isinstance(attributes, dict) and _FORMAT_KEY in attributes


def _read_meta(folder: Path) -> dict[str, Any]:
    attributes = _read_json(folder / "zarr.json")["attributes"]
    if attributes[_FORMAT_KEY] != FORMAT:
        raise FileFormatError(f"{folder} has format {attributes[_FORMAT_KEY]!r}; this program reads {FORMAT}")
    for key, kind in _META_KEYS.items():
        if not isinstance(attributes.get(key), kind):
            raise FileFormatError(f"{folder}/zarr.json has no valid {key}; save the map again")
    for key, kind in _OPTIONAL_META_KEYS.items():
        if key in attributes and not isinstance(attributes[key], kind):
            raise FileFormatError(f"{folder}/zarr.json has no valid {key}; save the map again")
    return {key: attributes[key] for key in (*_META_KEYS, *_OPTIONAL_META_KEYS) if key in attributes}


def _refuse_links(folder: Path) -> None:
    for parent, folders, files in os.walk(folder):
        for name in (*folders, *files):
            if Path(parent, name).is_symlink():
                raise FileFormatError(f"{Path(parent, name)} is a link; a photon map must not reach outside its folder")


def _check_array(folder: Path, column: Column) -> tuple[int, ...]:
    """Check an array's description and that every chunk is there, before anything is allocated for it."""
    document = _read_json(folder / "zarr.json")
    try:
        shape = tuple(document["shape"])
        chunks = tuple(document["chunk_grid"]["configuration"]["chunk_shape"])
        codecs = {codec["name"] for codec in document["codecs"]}
        dtype = np.dtype(document["data_type"])
    except (KeyError, TypeError, ValueError) as error:
        raise FileFormatError(f"{folder}/zarr.json is damaged; save the map again") from error
    tail = column.tail
    if column.any_width and len(shape) == 2 and 1 <= shape[1] <= MAX_PARAMETERS:
        tail = shape[1:]
    numbers = all(isinstance(n, int) and n >= 0 for n in (*shape, *chunks))
    limit = _MAX_VERTICES if column.of_vertices else MAX_PHOTONS + 1
    if not numbers or len(shape) != 1 + len(tail) or shape[1:] != tail or shape[0] > limit or len(chunks) != len(shape):
        raise FileFormatError(f"{folder} has shape {shape}, which {column.name} cannot have")
    if dtype != np.dtype(column.dtype):
        raise FileFormatError(f"{folder} holds {dtype}, {column.name} holds {np.dtype(column.dtype)}")
    if not 0 < chunks[0] <= CHUNK_ROWS or chunks[1:] != tail or codecs - _CODECS:
        raise FileFormatError(f"{folder} is chunked or coded in a way that this program does not write")
    for index in range(math.ceil(shape[0] / chunks[0])):
        if not folder.joinpath("c", str(index), *("0" for _ in tail)).is_file():
            raise FileFormatError(f"{folder} is damaged: chunk {index} is missing")
    return shape


def _read_array(folder: Path, column: Column) -> NDArray[Any]:
    import zarr  # noqa: PLC0415 - imported at first use: `import photonloupe` stays quick

    shape = _check_array(folder, column)
    try:
        values = np.asarray(zarr.open_array(store=folder, mode="r")[...])
    except MemoryError:
        raise
    except Exception as error:  # whatever a codec makes of damaged bytes
        raise FileFormatError(f"{folder} is damaged: {error}") from error
    if values.shape != shape:
        raise FileFormatError(f"{folder} is damaged: it has shape {values.shape}, not {shape}")
    return values
