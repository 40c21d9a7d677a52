# SPDX-License-Identifier: GPL-3.0-or-later
"""A dialogue with the server."""

from __future__ import annotations

import math
import select
import socket
import threading
import time
from collections import deque
from typing import Any, Callable, Deque, List, Optional, Tuple, TypeVar, Union

from ._message import Message, parse_message
from .errors import ConnectionFailed, Error, ProtocolError, Refused, Timeout

T = TypeVar("T")

#: ``"127.0.0.1:7001"``, a pair of host and port, or what has such an ``address`` (a Simrun).
Address = Union[str, Tuple[str, int], Any]


def host_and_port(address: Address) -> Tuple[str, int]:
    """The host and port that an address stands for."""
    address = getattr(address, "address", address)
    if isinstance(address, tuple):
        return str(address[0]), int(address[1])
    host, colon, port = str(address).rpartition(":")
    if not host or not colon or not port.isascii() or not port.isdigit() or not 0 < int(port) < 65536:
        raise Error(f"`{address}` is no address, wanted HOST:PORT, like 127.0.0.1:7001")
    return host.strip("[]"), int(port)


class Connection:
    """Sends requests, reads their answers, and stores messages that arrive in between.

    Threads may share one: requests are sent one after another, and each caller gets the answer to its own, also while
    another waits for a motion or an event. Of the threads that wait, one reads for all. Times to wait are seconds of
    wall time; infinity waits for ever.
    """

    _MOST_KEPT = 10000  # events and ends without a request
    _MOST_SCANS = 64

    def __init__(self, address: Address, timeout: float = 10, token: str = "") -> None:
        host, port = host_and_port(address)
        self.timeout = timeout  #: seconds to wait for each answer
        try:
            self._socket: Optional[socket.socket] = socket.create_connection((host, port), timeout)
        except socket.timeout:
            raise Timeout(f"{host}:{port} does not answer") from None
        except OSError as error:
            hint = " (is simrun running?)" if isinstance(error, ConnectionRefusedError) else ""
            raise ConnectionFailed(f"{host}:{port}: {error.strerror or error}{hint}") from None
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._socket.setblocking(False)
        self._sending = threading.Lock()  # held while a request is written
        # Guards all that follows but the buffer, which belongs to the thread that reads.
        self._changed = threading.Condition(threading.RLock())
        self._reading = False
        self._buffer = bytearray()
        self._searched = 0  # bytes of the buffer before this have no end of line
        # For each request that was sent and not answered, in order: the list that takes its answer. One whose caller
        # has given up remains, so that its late answer is not taken for that of the next.
        self._awaited: Deque[List[Message]] = deque()
        self._ends: Deque[Message] = deque(maxlen=self._MOST_KEPT)
        self._events: Deque[Message] = deque(maxlen=self._MOST_KEPT)
        self._scans: Deque[Message] = deque(maxlen=self._MOST_SCANS)
        try:
            self._greet(f"{host}:{port}", token)
        except BaseException:
            self._drop()
            raise

    def ask(self, request: str, timeout: Optional[float] = None) -> Message:
        """Sends one request and waits for its answer."""
        if "\n" in request:
            raise Error(f"a request is one line, found two in {request!r}")
        end = time.monotonic() + (self.timeout if timeout is None else timeout)
        answers: List[Message] = []
        if not self._sending.acquire(timeout=min(max(0, end - time.monotonic()), threading.TIMEOUT_MAX)):
            raise Timeout(f"another thread is still sending; no time for {request}")
        try:
            with self._changed:
                self._awaited.append(answers)
            self._send(request.encode() + b"\n", end)
        finally:
            self._sending.release()
        answer = self._until(lambda: answers[0] if answers else None, end)
        if answer is None:
            raise Timeout(f"no answer in time to {request}")
        if answer.word(0) == "ERR":
            raise _refusal(answer)
        return answer

    def take(self, found: Callable[[], Optional[T]], timeout: float) -> Optional[T]:
        """Reads until ``found`` returns something other than None, and returns it; None after the timeout.

        ``found`` is called once at first and after each message, by one thread at a time, and must not wait.
        """
        return self._until(found, time.monotonic() + timeout)

    def ends(self) -> List[Message]:
        """Removes and returns the DONE and FAIL that have been read; for the ``found`` of take()."""
        with self._changed:
            ends = list(self._ends)
            self._ends.clear()
        return ends

    def next_end(self, timeout: float) -> Optional[Message]:
        """Returns the next DONE or FAIL; None after the timeout."""
        return self._next(self._ends, timeout)

    def next_event(self, timeout: float) -> Optional[Message]:
        """Returns the next EVENT; None after the timeout."""
        return self._next(self._events, timeout)

    def stored_events(self) -> List[Message]:
        """Takes the EVENTs that have been received, without waiting."""
        with self._changed:
            events = list(self._events)
            self._events.clear()
        return events

    def next_scan(self, timeout: float) -> Optional[Message]:
        """Returns the next scan of a stream; None after the timeout."""
        return self._next(self._scans, timeout)

    def drop_scans(self) -> None:
        """Removes the unread scans of a stream."""
        with self._changed:
            self._scans.clear()

    def close(self) -> None:
        """Sends QUIT, so that its robot is free when this returns."""
        if self._socket is None:
            return
        try:
            if not self._awaited:
                self.ask("QUIT", 1)
        except Error:
            pass  # gone already
        self._drop()

    def _greet(self, name: str, token: str) -> None:
        greeting = self._read(time.monotonic() + self.timeout)
        if greeting is None:
            raise Timeout(f"no greeting from {name}")
        if greeting.word(0) == "ERR":
            raise _refusal(greeting)
        if greeting.line != "ISPACE 1":
            raise ProtocolError(f"{name} says `{greeting.line[:60]}`, wanted ISPACE 1")
        if token:
            self.ask("TOKEN " + token)

    def _drop(self) -> None:
        sock, self._socket = self._socket, None
        if sock is not None:
            try:
                sock.shutdown(socket.SHUT_RDWR)  # wakes a thread that reads
            except OSError:
                pass  # closed by the server
            sock.close()

    def _next(self, queue: Deque[Message], timeout: float) -> Optional[Message]:
        return self.take(lambda: queue.popleft() if queue else None, timeout)

    def _until(self, found: Callable[[], Optional[T]], end: float) -> Optional[T]:
        with self._changed:
            while (result := found()) is None:
                if self._reading:
                    left = min(end - time.monotonic(), threading.TIMEOUT_MAX)
                    if left <= 0 or not self._changed.wait(left):
                        return found()
                elif not self._store_next(end):
                    return None
        return result

    def _store_next(self, end: float) -> bool:
        """Reads one message for all threads and stores it by its kind; False after the timeout."""
        self._reading = True
        self._changed.release()
        try:
            message = self._read(end)
        finally:
            self._changed.acquire()
            self._reading = False
            self._changed.notify_all()
        if message is None:
            return False
        kind = message.word(0)
        if kind in ("DONE", "FAIL"):
            self._ends.append(message)
        elif kind == "EVENT":
            self._events.append(message)
        elif kind == "SCAN" and "stream" in message.fields:
            self._scans.append(message)
        elif kind in ("OK", "ERR", "SCAN"):
            if self._awaited:
                self._awaited.popleft().append(message)
            elif kind == "ERR":  # the server speaks first only to close: of too many clients, of one without a role
                raise _refusal(message)
            else:
                raise ProtocolError(f"the server answers `{message.line[:60]}` to no request")
        else:
            raise ProtocolError(f"the server says `{message.line[:60]}`")
        return True

    def _read(self, end: float) -> Optional[Message]:
        """Reads a line and its bytes; None after the timeout, which keeps received bytes."""
        while (newline := self._buffer.find(b"\n", self._searched)) < 0:
            self._searched = len(self._buffer)
            if not self._receive(end):
                return None
        self._searched = newline
        line = self._buffer[:newline].decode("utf-8", "replace").removesuffix("\r")
        message = parse_message(line)
        count = 0
        has_bytes = message.word(0) == "SCAN" or message.words[:2] == ["OK", "RECORDS"]
        if has_bytes and "bytes" in message.fields:
            count = message.fields.integer("bytes")
        while len(self._buffer) < newline + 1 + count:
            if not self._receive(end):
                return None
        if count:
            message.data = bytes(self._buffer[newline + 1 : newline + 1 + count])
        del self._buffer[: newline + 1 + count]
        self._searched = 0
        return message

    def _open(self) -> socket.socket:
        if self._socket is None:
            raise ConnectionFailed("the connection is closed")
        return self._socket

    def _wait(self, end: float, write: bool) -> bool:
        sock = self._open()
        # As poll() has whole milliseconds, rounded up: a short wait is no busy one.
        left = end - time.monotonic()
        poll = select.poll()
        poll.register(sock, select.POLLOUT if write else select.POLLIN)
        return bool(poll.poll(None if left == math.inf else max(0, math.ceil(left * 1000))))

    def _receive(self, end: float) -> bool:
        while True:
            try:
                data = self._open().recv(1 << 18)
            except BlockingIOError:
                if not self._wait(end, False):
                    return False
                continue
            except OSError as error:
                raise ConnectionFailed(f"the server is gone: {error.strerror}") from None
            if not data:
                raise ConnectionFailed("the server has closed the connection")
            self._buffer += data
            return True

    def _send(self, data: bytes, end: float) -> None:
        while data:
            try:
                data = data[self._open().send(data) :]
            except BlockingIOError:
                if not self._wait(end, True):
                    raise Timeout("the server takes no requests") from None
            except OSError as error:
                raise ConnectionFailed(f"the server is gone: {error.strerror}") from None


def _refusal(message: Message) -> Error:
    _, code, text = (message.line + "  ").split(" ", 2)
    if not code.isdigit():
        return ProtocolError(f"the server says {message.line}")
    return Refused(int(code), text.strip())


class Client:
    """Base of all roles: a connection, and ``with``."""

    def __init__(self, role: str, address: Address, timeout: float, token: str) -> None:
        self.connection = Connection(address, timeout, token)
        try:
            #: What the server said when the role was taken.
            self.info = self._ask(role).fields
        except BaseException:
            self.connection.close()
            raise

    def _ask(self, request: str, timeout: Optional[float] = None) -> Message:
        return self.connection.ask(request, timeout)

    def close(self) -> None:
        """Ends the connection; a robot or person brakes and is free for others."""
        self.connection.close()

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()
