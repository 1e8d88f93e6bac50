# SPDX-License-Identifier: Apache-2.0
"""Shows how far long work is and how long it will still take."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any

ProgressCallback = Callable[[str, float], bool | None]
ProgressLike = ProgressCallback | bool | None

# Finer than any terminal is wide; tqdm counts in these steps.
_STEPS_PER_STAGE = 1000


class ProgressBar:
    """One line on the terminal: the stage, a bar, and the time left; a new stage starts anew."""

    def __init__(self) -> None:
        self._bar: Any = None
        self._stage = ""

    def __call__(self, stage: str, fraction: float) -> bool:
        """Draw `fraction` in [0, 1] of `stage`; never asks to stop."""
        from tqdm import tqdm  # noqa: PLC0415 - imported at first use: `import photonloupe` stays quick

        if stage != self._stage or self._bar is None:
            self.close()
            self._stage = stage
            self._bar = tqdm(
                total=_STEPS_PER_STAGE,
                desc=stage,
                leave=False,
                bar_format="{desc}: {percentage:3.0f}% |{bar}| {elapsed}, {remaining} left",
            )
        self._bar.update(max(0, round(fraction * _STEPS_PER_STAGE) - self._bar.n))
        return True

    def close(self) -> None:
        """Take the line away."""
        if self._bar is not None:
            self._bar.close()
            self._bar = None


@contextlib.contextmanager
def follow_progress(progress: ProgressLike) -> Iterator[ProgressCallback | None]:
    """Give the callback that `progress` stands for: True a bar, False or None nothing, else itself."""
    if callable(progress):
        yield progress
    elif progress:
        bar = ProgressBar()
        try:
            yield bar
        finally:
            bar.close()
    else:
        yield None
