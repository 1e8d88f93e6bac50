# SPDX-License-Identifier: Apache-2.0
"""What a relaxation was told, made complete for its map."""

from __future__ import annotations

import logging
from typing import Any, Unpack

from photonloupe import _engine
from photonloupe.device_photons import DevicePhotons
from photonloupe.errors import ArgumentError
from photonloupe.isotropy import BETA_NEIGHBORS, CLIPPED_SHARE, explain_no_ratio, find_beta
from photonloupe.progress import ProgressLike
from photonloupe.setting_keywords import AllRelaxKeywords
from photonloupe.settings import check_settings, list_settings, name_emission

LOG = logging.getLogger("photonloupe")


def check_beta(value: Any, photons: DevicePhotons, progress: ProgressLike = None) -> float:
    """Return β as a number, found from the map when it is ``"auto"``; the default where every β would do."""
    setting = list_settings("relax")["beta"]
    checked = setting.check(value)
    if checked is not None:
        return float(checked)
    beta = find_beta(photons, BETA_NEIGHBORS, CLIPPED_SHARE, progress)
    if beta is None:
        LOG.warning(explain_no_ratio(photons))
    return float(setting.default if beta is None else beta)


def complete_settings(
    photons: DevicePhotons, progress: ProgressLike, **given: Unpack[AllRelaxKeywords]
) -> dict[str, Any]:
    """Check all of a relaxation's settings and fill in those that are automatic; β is 0 where no layer counts."""
    has_parameters = "parameters" in photons.recorded
    checked = check_settings("relax", given)
    settings = _engine.complete_relaxation(checked, name_emission(photons.settings), has_parameters)
    for name in ("constraint", "repel"):
        if settings[name] == "parameter" and not has_parameters:
            raise ArgumentError(f'{name}="parameter" needs parameters; set_parameters() or a script sets them')
    has_constraint = settings["descriptor"] != "none"
    needs_beta = settings["repel"] == "parameter" or (has_constraint and settings["constraint"] == "parameter")
    beta = check_beta(given.get("beta"), photons, progress) if needs_beta else 0.0
    return {**settings, "beta": beta}
