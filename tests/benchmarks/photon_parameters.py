# SPDX-License-Identifier: Apache-2.0
"""Gives a map the parameters of the relaxation benchmarks: where each photon left its light."""

from __future__ import annotations

import photonloupe as pl


def set_trajectory(photons: pl.PhotonMap) -> None:
    """Give a map its planar primal trajectory as parameters."""
    photons.set_parameters(pl.find_primal_trajectory(photons), names=("right", "up"))
