"""A client of ``coolinggen serve``: starts it, asks it, and says in one type what went wrong.

Nothing here knows of FreeCAD, so that other programs may use it as it stands.
"""

import contextlib
import itertools
import json
import os
import queue
import shutil
import signal
import subprocess
import threading
from collections.abc import Callable
from pathlib import Path

PROTOCOL_VERSION = 1
STARTING_S = 20.0  #: A program that has not introduced itself after so many seconds is none of ours.
NAME = "coolinggen.exe" if os.name == "nt" else "coolinggen"


class SidecarError(Exception):
    """What the sidecar answered with, or why there is no answer."""


class MissingError(SidecarError):
    """There is no sidecar, or one that speaks another protocol."""


class GoneError(SidecarError):
    """The sidecar has ended."""


class CancelledError(SidecarError):
    """The request was cancelled."""


class RefusedError(SidecarError):
    """Parameters or design are wrong: ``faults`` has everything, each with its JSON pointer."""

    def __init__(self, message: str, faults: list[dict]):
        super().__init__(message)
        self.faults = faults


def find(preferred: str = "") -> Path:
    """The sidecar's binary: the preferred one, the one in the add-on's folder, or the one on the path."""
    if preferred:
        if not Path(preferred).is_file():
            raise MissingError(f"there is no coolinggen at {preferred}: look at the preferences")
        return Path(preferred)
    bundled = Path(__file__).parent.parent / "bin" / NAME
    if bundled.is_file():
        _executable(bundled)
        return bundled
    found = shutil.which(NAME)
    if found is None:
        raise MissingError(
            "coolinggen is neither beside the add-on nor on the PATH: say in the preferences where it is"
        )
    return Path(found)


def _executable(program: Path) -> None:
    """Gives a program the permission to run that unpacking may have taken from it."""
    if not os.access(program, os.X_OK):
        # Where it can't be had, starting the program says so.
        with contextlib.suppress(OSError):
            program.chmod(program.stat().st_mode | 0o755)


@contextlib.contextmanager
def _broken_pipes_are_errors():
    """Makes writing to a program that has ended an ``OSError``, whatever the host does with SIGPIPE.

    A stand-alone Python ignores that signal. A program that embeds one may leave it as it is, and then
    ends with the sidecar: FreeCAD 1.0 does. Only this thread holds the signal back.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGPIPE})
    try:
        yield
    finally:
        if signal.SIGPIPE not in before:
            if signal.SIGPIPE in signal.sigpending():
                signal.sigwait({signal.SIGPIPE})
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


class Sidecar:
    """A running sidecar. Requests may be made from any thread, several at once."""

    def __init__(self, binary: Path, client: str):
        """Starts ``binary`` and introduces ``client``."""
        hidden = {"creationflags": subprocess.CREATE_NO_WINDOW} if os.name == "nt" else {}
        try:
            self._process = subprocess.Popen(
                [str(binary), "serve"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                encoding="utf-8",
                **hidden,
            )
        except OSError as error:
            raise MissingError(f"{binary} does not start: {error}") from error
        self._ids = itertools.count(1)
        self._waiting: dict[int, queue.Queue] = {}
        self._lock = threading.Lock()
        # Apart from the other: who writes a long line must not keep the reader from the answers.
        self._writing = threading.Lock()
        threading.Thread(target=self._read, daemon=True).start()
        impatience = threading.Timer(STARTING_S, self._process.kill)
        impatience.start()
        try:
            self.server = self.call("initialize", protocol_version=PROTOCOL_VERSION, client={"name": client})
        except SidecarError as error:
            self.close()
            raise MissingError(
                f"{binary} is no sidecar for this add-on, or too old or too new for it: {error}"
            ) from error
        finally:
            impatience.cancel()

    @property
    def alive(self) -> bool:
        """Whether it can still be asked."""
        return self._process.poll() is None

    def call(
        self,
        method: str,
        *,
        progress: Callable[[str, float], None] | None = None,
        cancelled: Callable[[], bool] | None = None,
        **params: object,
    ) -> dict:
        """The result of a request.

        ``progress`` is told the stage and the fraction done; ``cancelled`` is asked ten times a second
        whether to give up.
        """
        number = next(self._ids)
        answers: queue.Queue = queue.Queue()
        with self._lock:
            self._waiting[number] = answers
        try:
            self._send({"id": number, "method": method, "params": params})
            return self._await(number, answers, progress, cancelled)
        finally:
            with self._lock:
                self._waiting.pop(number, None)

    def _await(self, number, answers, progress, cancelled) -> dict:
        asked_to_stop = False
        while True:
            try:
                message = answers.get(timeout=0.1)
            except queue.Empty:
                if cancelled is not None and not asked_to_stop and cancelled():
                    asked_to_stop = True
                    self._send({"method": "$/cancelRequest", "params": {"id": number}})
                continue
            if message is None:
                raise GoneError("coolinggen has ended")
            if message.get("method") == "$/progress":
                if progress is not None:
                    progress(message["params"]["stage"], message["params"]["fraction"])
            elif "error" in message:
                raise _error(message["error"])
            elif "result" in message:
                return message["result"]
            else:
                raise SidecarError("the answer is none of coolinggen's")

    def _send(self, message: dict) -> None:
        line = json.dumps({"jsonrpc": "2.0", **message}, allow_nan=False)
        try:
            with self._writing, _broken_pipes_are_errors():
                self._process.stdin.write(line + "\n")
                self._process.stdin.flush()
        except (OSError, ValueError) as error:
            raise GoneError("coolinggen has ended") from error

    def _read(self) -> None:
        for line in self._process.stdout:
            try:
                message = json.loads(line)
                number = message["id"] if "id" in message else message.get("params", {}).get("id")
            except (ValueError, AttributeError):
                # Whatever this is, it is no sidecar.
                self._process.kill()
                break
            with self._lock:
                answers = self._waiting.get(number)
            if answers is not None:
                answers.put(message)
        self._process.wait()
        with self._lock:
            for answers in self._waiting.values():
                answers.put(None)

    def close(self) -> None:
        """Ends it."""
        with self._writing, _broken_pipes_are_errors():
            if not self._process.stdin.closed:
                # It may be dead already.
                with contextlib.suppress(OSError):
                    self._process.stdin.close()
        self._process.wait()


def _error(error: dict) -> SidecarError:
    if error["code"] == -32800:
        return CancelledError(error["message"])
    if error["code"] == -32602:
        return RefusedError(error["message"], error.get("data", []))
    return SidecarError(error["message"])
