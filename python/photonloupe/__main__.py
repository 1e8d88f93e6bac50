# SPDX-License-Identifier: Apache-2.0
"""Lets ``python -m photonloupe`` be the program."""

import sys

from photonloupe.cli import main

sys.exit(main())
