# SPDX-License-Identifier: Apache-2.0
"""The program: reads the command line, runs a verb, turns errors into one message and an exit code."""

from __future__ import annotations

import argparse
import os
import sys
import traceback
from collections.abc import Sequence
from typing import NoReturn

from photonloupe import __version__
from photonloupe.cli import compare, demo, doctor, relax, render, script, studio, trace
from photonloupe.cli.common import (
    EXIT_BAD_INPUT,
    EXIT_INTERNAL,
    EXIT_INTERRUPTED,
    EXIT_NO_DEVICE,
    EXIT_NO_MEMORY,
    EXIT_OK,
    add_common_options,
)
from photonloupe.errors import Cancelled, DeviceError, DeviceMemoryError, PhotonLoupeError, ScriptError

_VERBS = (render, trace, script, relax, studio, compare, doctor, demo)


class _Parser(argparse.ArgumentParser):
    """Says in one line what is wrong with the command line."""

    def error(self, message: str) -> NoReturn:
        self.exit(EXIT_BAD_INPUT, f"{self.prog}: {message}; see {self.prog} --help\n")


def build_parser() -> argparse.ArgumentParser:
    """Build the parser of every verb."""
    parser = _Parser(
        prog="photonloupe",
        description="Photon mapping as data: trace, script, relax, render, inspect, compare.",
        epilog="Exit codes: 0 ok, 1 the answer is no, 2 wrong use or bad input, 3 no usable device, 4 out of memory.",
    )
    parser.add_argument("--version", action="version", version=f"photonloupe {__version__}")
    verbs = parser.add_subparsers(dest="verb", metavar="VERB", required=True, parser_class=_Parser)
    for module in _VERBS:
        name = module.__name__.rpartition(".")[2]
        verb = verbs.add_parser(name, help=module.SUMMARY, description=module.DESCRIPTION)
        module.add_options(verb)
        add_common_options(verb)
        verb.set_defaults(run=module.run)
    return parser


def _choose_exit_code(error: BaseException) -> int:
    if isinstance(error, KeyboardInterrupt | Cancelled):
        return EXIT_INTERRUPTED
    if isinstance(error, DeviceMemoryError | MemoryError):
        return EXIT_NO_MEMORY
    if isinstance(error, DeviceError):
        return EXIT_NO_DEVICE
    if isinstance(error, PhotonLoupeError | OSError):
        return EXIT_BAD_INPUT
    return EXIT_INTERNAL


def _describe_error(error: BaseException, code: int) -> str:
    if code == EXIT_INTERRUPTED:
        return "stopped on request; nothing was written"
    if isinstance(error, ScriptError):
        return "the script is wrong\n" + str(error)
    text = " ".join(str(error).split()) or type(error).__name__
    if code == EXIT_NO_MEMORY and isinstance(error, MemoryError):
        return f"out of memory ({text}); ask for fewer photons or pixels"
    if code == EXIT_INTERNAL:
        return f"internal error, {type(error).__name__}: {text}; please report it with the output of --debug"
    return text


def main(argv: Sequence[str] | None = None) -> int:
    """Run the program and return its exit code.

    Parameters
    ----------
    argv
        The arguments after the program's name; default those of the process.
    """
    try:
        arguments = build_parser().parse_args(argv)
    except SystemExit as stop:
        return stop.code if isinstance(stop.code, int) else EXIT_OK
    try:
        code = int(arguments.run(arguments))
        sys.stdout.flush()
        return code
    except BrokenPipeError:
        # Whoever read our output has seen enough; nothing more can be said to it.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return EXIT_OK
    except (Exception, KeyboardInterrupt) as error:
        if arguments.debug:
            traceback.print_exc()
        code = _choose_exit_code(error)
        print(f"photonloupe {arguments.verb}: {_describe_error(error, code)}", file=sys.stderr)
        return code
