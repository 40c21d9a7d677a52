# SPDX-License-Identifier: GPL-3.0-or-later
"""A folder for the files of one job at a time, beside which its inputs seem to lie as they do beside the sweep's."""

from __future__ import annotations

import contextlib
import fcntl
import os
import shutil
import tempfile
import time

PREFIX = "ispace-sweep."
LOCK = ".lock"


class Scratch:
    """A copy of the current folder's path below a temporary folder, in which links stand for all that is there. A job
    that runs in it names its files as it would in the current folder, and writes the same bytes: a layout holds the way
    from its folder to its room. What it writes stays here.

    `folder` is that of the sweep's files, relative to the current folder."""

    def __init__(self, folder: str) -> None:
        _remove_abandoned()
        self._root = tempfile.mkdtemp(prefix=PREFIX)
        self._lock = _locked(self._root)
        self._real = os.path.realpath(os.getcwd())
        self.path = self._root + self._real
        self._mirrored: set[str] = set()
        self._ways: dict[bytes, bytes] = {}  # to inputs with absolute names, from here, and from the real folder
        self._mirror(self._real)
        self._from = folder
        self._folder = os.path.join(self.path, folder)
        if not os.path.isabs(folder):
            self._open(folder)
        os.makedirs(self._folder, exist_ok=True)
        self._kept = set(os.listdir(self._folder))

    def close(self) -> None:
        _remove(self._root)
        os.close(self._lock)

    def mirror(self, file: str) -> None:
        """Makes the folder of an input a folder here, too, so that relative ways from and to it are right. An absolute
        name has the same meaning everywhere, but not the way to it."""
        here, there = os.path.realpath(self._folder), os.path.realpath(os.path.join(self._real, self._from))
        for name in (file, os.path.realpath(file)):  # the tools look where links lead
            if os.path.isabs(name):
                self._ways[os.path.relpath(name, here).encode()] = os.path.relpath(name, there).encode()
        if not os.path.isabs(file) and os.path.dirname(file):
            self._open(os.path.dirname(file))

    def placed(self, content: bytes) -> bytes:
        """Replaces ways from the scratch folder to inputs with absolute names, in text, by those from the real one."""
        if b"\0" in content:
            return content
        for here, there in self._ways.items():
            content = content.replace(here, there)
        return content

    def real(self, text: str) -> str:
        """Replaces the scratch folder by the current one in a message."""
        return text.replace(self.path + os.sep, "").replace(self._root, "")

    def free(self, path: str) -> None:
        """Makes room for a file of a job: one of that name in the real folder stays as it is."""
        here = os.path.join(self.path, path)
        if os.path.islink(here):
            os.unlink(here)
        self._kept.discard(os.path.basename(path))

    def empty(self) -> None:
        """Removes the files of a job."""
        with os.scandir(self._folder) as entries:
            for entry in entries:
                if entry.name in self._kept:
                    continue
                if entry.is_dir(follow_symlinks=False):
                    shutil.rmtree(entry.path, ignore_errors=True)
                else:
                    os.unlink(entry.path)

    def _open(self, folder: str) -> None:
        """Makes a relative folder, step by step, a real one with links."""
        real = self._real
        for step in folder.split(os.sep):
            real = os.path.normpath(os.path.join(real, step))
            if not os.path.isdir(real):  # made by the jobs: nothing to link
                os.makedirs(self._root + real, exist_ok=True)
            elif os.path.islink(real):  # a room behind it lies where it points
                return
            else:
                self._mirror(real)

    def _mirror(self, real: str) -> None:
        """Fills the counterpart of a folder with links, except where there are folders already."""
        if real in self._mirrored:
            return
        self._mirrored.add(real)
        here = self._root + real
        if os.path.islink(here):
            os.unlink(here)
        os.makedirs(here, exist_ok=True)
        with os.scandir(real) as entries:
            for entry in entries:
                link = os.path.join(here, entry.name)
                if not os.path.lexists(link):
                    os.symlink(entry.path, link)


def _locked(root: str) -> int:
    """Marks a scratch folder as in use, for as long as this process lives."""
    lock = os.open(os.path.join(root, LOCK + ".new"), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    fcntl.flock(lock, fcntl.LOCK_EX)
    os.rename(os.path.join(root, LOCK + ".new"), os.path.join(root, LOCK))
    return lock


def _remove(root: str) -> None:
    """Removes a scratch folder, its lock last. A job that was killed may still be writing for a moment."""
    for _ in range(50):
        for name in os.listdir(root):
            if name != LOCK:
                shutil.rmtree(os.path.join(root, name), ignore_errors=True)
        if os.listdir(root) in ([], [LOCK]):
            break
        time.sleep(0.02)
    shutil.rmtree(root, ignore_errors=True)


def _remove_abandoned() -> None:
    """Removes scratch folders of this user's runs that were killed."""
    with os.scandir(tempfile.gettempdir()) as entries:
        roots = [entry.path for entry in entries if entry.name.startswith(PREFIX)]
    for root in roots:
        with contextlib.suppress(OSError):
            if os.lstat(root).st_uid != os.getuid():
                continue
            lock = os.open(os.path.join(root, LOCK), os.O_RDWR | os.O_CLOEXEC | os.O_NOFOLLOW)
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                _remove(root)
            finally:
                os.close(lock)
