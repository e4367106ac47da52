"""Work beside the window: a thread that does the newest job and gives up older ones."""

import queue
import threading
from collections.abc import Callable
from dataclasses import dataclass

from .sidecar import CancelledError


@dataclass(frozen=True)
class Done:
    """How a job ended: with a result or an error."""

    tag: object
    result: object = None
    error: Exception | None = None


@dataclass(frozen=True)
class Progress:
    """How far a job is: ``fraction`` of the whole."""

    tag: object
    stage: str
    fraction: float


class Watch:
    """What a job looks at while it works."""

    def __init__(self, tag: object, news: queue.Queue):
        self._tag, self._news = tag, news
        self._stop = threading.Event()

    def stop(self) -> None:
        """Asks the job to give up."""
        self._stop.set()

    def stopped(self) -> bool:
        """Whether it was asked to."""
        return self._stop.is_set()

    def progress(self, stage: str, fraction: float) -> None:
        """Tells how far it is."""
        self._news.put(Progress(self._tag, stage, fraction))

    def check(self) -> None:
        """Ends the job if it was asked to give up."""
        if self.stopped():
            raise CancelledError("cancelled")


class Latest:
    """Runs one job at a time, the newest; ``news`` has what happened, for the window's thread to fetch."""

    def __init__(self):
        self._news: queue.Queue = queue.Queue()
        self._lock = threading.Condition()
        self._waiting: tuple[object, Callable[[Watch], object]] | None = None
        self._running: Watch | None = None
        self._closed = False
        threading.Thread(target=self._work, daemon=True, name="coolinggen").start()

    def submit(self, job: Callable[[Watch], object], tag: object = None) -> None:
        """``job`` is done next; what runs is asked to give up, what waits is forgotten."""
        with self._lock:
            self._waiting = (tag, job)
            if self._running is not None:
                self._running.stop()
            self._lock.notify()

    def cancel(self) -> None:
        """Gives up what runs and what waits."""
        with self._lock:
            self._waiting = None
            if self._running is not None:
                self._running.stop()

    @property
    def busy(self) -> bool:
        """Whether a job runs or waits."""
        with self._lock:
            return self._running is not None or self._waiting is not None

    def news(self) -> list[Done | Progress]:
        """What happened since it was last asked for; never waits."""
        told = []
        while True:
            try:
                told.append(self._news.get_nowait())
            except queue.Empty:
                return told

    def close(self) -> None:
        """Gives up everything and ends the thread as soon as its job has."""
        self.cancel()
        with self._lock:
            self._closed = True
            self._lock.notify()

    def _work(self) -> None:
        while True:
            with self._lock:
                while self._waiting is None and not self._closed:
                    self._lock.wait()
                if self._closed:
                    return
                tag, job = self._waiting
                self._waiting = None
                watch = self._running = Watch(tag, self._news)
            try:
                done = Done(tag, job(watch))
            except Exception as error:  # told to whoever asked for the job
                done = Done(tag, error=error)
            # The job is over before its end is told, so that who hears of it finds nothing running.
            with self._lock:
                self._running = None
            self._news.put(done)
