"""Work beside the window: jobs of threads, and steps of the window's thread that follow from them.

A job has a key; a job that is started takes the place of an earlier one of its key.
"""

import itertools
import time
from collections import deque
from collections.abc import Callable, Hashable, Iterable

from .client.latest import Done, Latest, Progress, Watch

Step = Callable[[], None]

_workers: dict[Hashable, Latest] = {}
_numbers = itertools.count()
#: By key the number of the job that is waited for, and what makes steps of its end.
_awaited: dict[Hashable, tuple[int, Callable[[Done], Iterable[Step]]]] = {}
_steps: deque[tuple[Hashable, Step]] = deque()
_progress: dict[Hashable, Progress] = {}


def start(key: Hashable, job: Callable[[Watch], object], ended: Callable[[Done], Iterable[Step]]) -> None:
    """Has ``job`` done by a thread; ``ended`` makes of its end steps for the window's thread, each short."""
    number = next(_numbers)
    _awaited[key] = number, ended
    _workers.setdefault(key, Latest()).submit(job, number)


def wait(key: Hashable) -> None:
    """Returns when the job and its steps are done."""
    while working(key):
        turn()
        time.sleep(0.001)


def working(key: Hashable) -> bool:
    """Whether a job of this key, or a step that followed from it, is still to be done."""
    return key in _awaited or any(key == other for other, _ in _steps)


def busy() -> bool:
    """Whether anything is still to be done."""
    return bool(_awaited or _steps)


def progress(key: Hashable) -> Progress | None:
    """How far a job is."""
    return _progress.get(key)


def turn() -> bool:
    """Hears the news and does one step, and says whether there was any.

    For the window's thread, at short intervals.
    """
    heard = _hear()
    if not _steps:
        return heard
    _steps.popleft()[1]()
    return True


def cancel() -> None:
    """Gives up all jobs. Steps of those that have ended are still done."""
    _awaited.clear()
    _progress.clear()
    for worker in _workers.values():
        worker.cancel()


def stop() -> None:
    """Ends everything that was begun."""
    cancel()
    _steps.clear()
    for worker in _workers.values():
        worker.close()
    _workers.clear()


def _hear() -> bool:
    heard = False
    for key, worker in _workers.items():
        for news in worker.news():
            number, ended = _awaited.get(key, (None, None))
            if news.tag != number:
                continue
            heard = True
            if isinstance(news, Progress):
                _progress[key] = news
            else:
                del _awaited[key]
                _progress.pop(key, None)
                _steps.extend((key, step) for step in ended(news))
    return heard
