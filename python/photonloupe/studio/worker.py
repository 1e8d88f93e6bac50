# SPDX-License-Identifier: Apache-2.0
"""Does the studio's work: in a thread while frames go on, or in the frame itself."""

from __future__ import annotations

import threading

from photonloupe import _engine
from photonloupe.studio.stages import Stages, describe_error, read_job


class Worker:
    """Takes one job at a time from the interface.

    Parameters
    ----------
    native
        The interface.
    stages
        What does the work.
    is_threaded
        Work in a thread; else `take_turn` returns when the job is done.
    """

    def __init__(self, native: _engine.Studio, stages: Stages, *, is_threaded: bool) -> None:
        self._native = native
        self._stages = stages
        self._is_threaded = is_threaded
        self._thread: threading.Thread | None = None

    @property
    def is_busy(self) -> bool:
        """Whether a job is running in the thread."""
        return self._thread is not None and self._thread.is_alive()

    def take_turn(self) -> bool:
        """Begin the next job, if one waits and none runs; True: it has been done, and a frame should show it."""
        if self.is_busy:
            return False
        job = self._native.take_job()
        if job is None:
            return False
        if not self._is_threaded:
            self._work(*job)
            return True
        self._thread = threading.Thread(target=self._work, args=tuple(job), daemon=True)
        self._thread.start()
        return False

    def stop(self) -> None:
        """Ask the job to stop; it does between two chunks of its work."""
        self._native.stop_job()

    def close(self) -> None:
        """Stop the job and wait for it."""
        self.stop()
        if self._thread is not None:
            self._thread.join()

    def _work(self, kind: str, key: str, settings: str) -> None:
        message = ""
        try:
            self._stages.run(kind, read_job(settings), self._native.report_progress)
        except Exception as error:  # whatever it is, the interface says it and goes on
            message = f"{kind}: {describe_error(error)}"
        self._native.end_job(kind, key, message)
