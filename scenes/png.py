# SPDX-License-Identifier: Apache-2.0
"""Writes PNG images uncompressed, so that the same pixels are the same bytes with every version of zlib."""

from __future__ import annotations

import struct
import zlib

import numpy as np
from numpy.typing import NDArray

_STORED = 0xFFFF  # bytes of a stored block at most
_COLOR_TYPES = {1: 0, 3: 2, 4: 6}  # PNG's, by channels


def _pack_chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def encode_png(codes: NDArray[np.uint8]) -> bytes:
    """PNG of (height, width, channels) codes; 1, 3 or 4 channels, sRGB where they are colors."""
    height, width, channels = codes.shape
    rows = np.concatenate([np.zeros((height, 1), np.uint8), codes.reshape(height, -1)], axis=1).tobytes()
    blocks = [rows[at : at + _STORED] for at in range(0, len(rows), _STORED)]
    body = b"".join(
        struct.pack("<BHH", i == len(blocks) - 1, len(block), len(block) ^ 0xFFFF) + block
        for i, block in enumerate(blocks)
    )
    data = b"\x78\x01" + body + struct.pack(">I", zlib.adler32(rows))
    header = struct.pack(">IIBBBBB", width, height, 8, _COLOR_TYPES[channels], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        _pack_chunk(kind, part) for kind, part in ((b"IHDR", header), (b"IDAT", data), (b"IEND", b""))
    )


def encode_srgb(linear: NDArray[np.float64]) -> NDArray[np.uint8]:
    """Codes of linear values in [0, 1]."""
    curved = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0.0031308) ** (1.0 / 2.4) - 0.055)
    return np.round(255.0 * np.clip(curved, 0.0, 1.0)).astype(np.uint8)
