# SPDX-License-Identifier: Apache-2.0
"""Names a cycle of what uses what."""

from __future__ import annotations

from collections.abc import Mapping
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise


def name_cycle(reasons: Mapping[tuple[str, str], str]) -> str:
    """Name a cycle of steps (user, used), with the reason given for each; empty where there is none."""
    graph: dict[str, set[str]] = {}
    for user, used in reasons:
        graph.setdefault(user, set()).add(used)
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        places = error.args[1][::-1]  # each uses the next
        steps = [reasons[step] for step in pairwise(places)]
        return " → ".join(places) + ": " + "; ".join(steps)
    return ""
