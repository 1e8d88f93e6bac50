# SPDX-License-Identifier: Apache-2.0
"""Copies a photon map's columns into the tables of other libraries."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from photonloupe.columns import PATH_COLUMNS, PHOTON_COLUMNS
from photonloupe.errors import PhotonLoupeError

if TYPE_CHECKING:
    import pandas
    import pyarrow

# Colors and coordinates both come in threes; these suffixes serve pandas, which has no vectors.
_AXES = ("x", "y", "z")
_CHANNELS = ("r", "g", "b")


def build_table(columns: Mapping[str, NDArray[Any]]) -> pyarrow.Table:
    """Build an Arrow table of what is recorded: one row a photon, a path's vertices as a list."""
    import pyarrow  # noqa: PLC0415 - imported at first use: `import photonloupe` stays quick

    def convert(values: NDArray[Any]) -> pyarrow.Array:
        flat = pyarrow.array(np.ascontiguousarray(values).ravel())
        return pyarrow.FixedSizeListArray.from_arrays(flat, values.shape[1]) if values.ndim == 2 else flat

    table: dict[str, Any] = {column.name: convert(columns[column.name]) for column in PHOTON_COLUMNS}
    for column in PATH_COLUMNS:
        if column.name in columns:
            offsets = pyarrow.array(columns["path_offsets"])
            table[column.name] = pyarrow.LargeListArray.from_arrays(offsets, convert(columns[column.name]))
    return pyarrow.table(table)


def build_frame(columns: Mapping[str, NDArray[Any]]) -> pandas.DataFrame:
    """Build a pandas data frame of the photon columns."""
    try:
        import pandas  # noqa: PLC0415 - optional
    except ImportError:
        raise PhotonLoupeError("to_pandas needs pandas: pip install pandas; to_arrow works without it") from None

    frame: dict[str, NDArray[Any]] = {}
    for column in PHOTON_COLUMNS:
        values = columns[column.name]
        if values.ndim == 1:
            frame[column.name] = values
            continue
        for channel, suffix in enumerate(_CHANNELS if column.name == "power" else _AXES):
            frame[f"{column.name}_{suffix}"] = values[:, channel]
    return pandas.DataFrame(frame)
