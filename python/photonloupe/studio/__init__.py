# SPDX-License-Identifier: Apache-2.0
"""The interactive tool."""

from photonloupe.studio.studio import Studio

__all__ = ["Studio"]
