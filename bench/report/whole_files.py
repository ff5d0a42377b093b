# SPDX-License-Identifier: MIT
"""Files that are written whole or not at all."""

import os
import pathlib
import tempfile


def write_text(path, text):
    """Replaces a file when all of it is on the disk. After a failure, an old file stays. A device
    is written directly."""
    path = pathlib.Path(os.path.realpath(path))
    if path.exists() and not path.is_file():
        path.write_text(text, encoding="utf-8")
        return
    with tempfile.NamedTemporaryFile("w", encoding="utf-8", dir=path.parent, prefix=".cellist-",
                                     delete=False) as unfinished:
        try:
            os.chmod(unfinished.name, path.stat().st_mode & 0o7777 if path.exists() else 0o666 & ~_umask())
            unfinished.write(text)
            unfinished.flush()
            os.fsync(unfinished.fileno())
            os.replace(unfinished.name, path)
        except BaseException:
            os.unlink(unfinished.name)
            raise


def _umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask
