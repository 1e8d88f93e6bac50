# SPDX-License-Identifier: Apache-2.0
"""Real files load and render.

Fetching needs npm and PyPI, so that this runs by its path alone: `./photonloupe python -m pytest tests/corpus`.
"""

from __future__ import annotations

import pytest
from corpus import list_files, run_file

# Of black plastic, which nothing of what lights it is thrown back from to so small a picture.
BLACK = "microsoft-mixed-reality/right.glb"


@pytest.mark.parametrize("name", list_files())
def test_a_real_file_loads_and_renders(name: str) -> None:
    result = run_file(name)
    assert (result.loaded, result.rendered) == ("yes", "black" if name.endswith(BLACK) else "yes")
