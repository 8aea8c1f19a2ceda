"""Locks on folders, so that two programs never work in the same one.

A lock is the kernel's (flock), on a file that says who holds it. The kernel drops it with the last process that has the file
open: what a killed process leaves behind is a file without a lock, never a stale lock.
"""

from __future__ import annotations

import fcntl
import os
import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


class Locked(Exception):
    """Another process holds the lock; the text says which."""


def try_lock(descriptor: int, kind: int) -> bool:
    try:
        fcntl.flock(descriptor, kind | fcntl.LOCK_NB)
        return True
    except BlockingIOError:
        return False


def holder(path: Path) -> str:
    """Who holds the lock, or held it last."""
    try:
        return path.read_text().strip() or "another process"
    except OSError:
        return "another process"


def is_locked(path: Path | str) -> bool:
    """Does any process hold the lock? Asks with a shared lock, which other askers do not mind."""
    try:
        descriptor = os.open(path, os.O_RDONLY)
    except OSError:
        return False
    try:
        return not try_lock(descriptor, fcntl.LOCK_SH)
    finally:
        os.close(descriptor)


@contextmanager
def locked(path: Path, patience: float = 1.0) -> Iterator[int]:
    """Holds the lock and gives its descriptor; a child process that inherits it goes on holding the lock if this one is killed.

    Raises Locked when it is not free within `patience` seconds (a moment at least: see is_locked).
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
    try:
        end = time.monotonic() + patience
        while not try_lock(descriptor, fcntl.LOCK_EX):
            if time.monotonic() > end:
                raise Locked(holder(path))
            time.sleep(0.1)
        os.truncate(descriptor, 0)
        os.pwrite(descriptor, f"process {os.getpid()} on {socket.gethostname()} since {time.strftime('%F %T')}\n".encode(), 0)
        yield descriptor
    finally:
        os.close(descriptor)
