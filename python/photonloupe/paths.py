# SPDX-License-Identifier: Apache-2.0
"""Signatures of paths, as users write them."""

from __future__ import annotations

from photonloupe.checks import check_count
from photonloupe.errors import ArgumentError

_SCATTERED = 3


def parse_signature(signature: str | int) -> list[int]:
    """Turn a signature into its interactions, first one first.

    Parameters
    ----------
    signature
        Digits 1 (reflected), 2 (transmitted) and 3 (scattered by a medium) in the order of the path, as in ``"22"``,
        or the number of [SJL15] eq. 2, whose least significant base-3 digit is the first interaction and whose
        digit 0 stands for scattered.
    """
    if isinstance(signature, str):
        if set(signature) - {"1", "2", "3"}:
            raise ArgumentError(
                f"a signature is made of 1 (reflected), 2 (transmitted) and 3 (scattered), not {signature!r}"
            )
        return [int(digit) for digit in signature]
    number = check_count("signature", signature, 0, 2**63 - 1)
    digits = []
    while number:
        number, digit = divmod(number, 3)
        digits.append(digit or _SCATTERED)
    return digits
