# SPDX-License-Identifier: MIT
"""What distributed lists cost one rank: bytes, messages, memory and time by a model. docs/mpi-scaling.md
explains it."""

RANKS = (8, 64, 1024)
RECORD_BYTES = 16
SENT_BYTES = 20  # a record and its cell
OCCUPANCY = 16  # records in a cell
COPIES = 3  # of a foreign record: in the outbox, in the order of the ranks, and where it arrives
# Measured on a host with two H200:
SHARED = 42e9  # bytes per second of a rank from its device to those of other ranks, through shared memory
PINNED = 55e9  # bytes per second from the device or to it, in other page-locked memory
FIXED = 0.2e-3  # seconds of launches, reductions and short copies in each exchange
KERNELS = 0.1e-9  # seconds for a sent record, from the outbox to the lists
BUILD = 7.7e-3 / 2**26  # seconds for a record in a random cell of contiguous lists
MOVE = 0.04e-9  # seconds for a record of contiguous lists that move for their ghost cells
# Not measured:
HOST_RANKS = 8  # ranks of one host
NETWORK = 12.5e9  # bytes per second of a rank between hosts
MESSAGE = 5e-6  # seconds for a message between hosts


def blocks(ranks):
    """Blocks along three axes, for a power of two."""
    bits = ranks.bit_length() - 1
    return [2 ** ((bits + axis) // 3) for axis in range(3)]


def neighbours(ranks):
    """Ranks around one, in a periodic box: at most 26."""
    count = 1
    for along in blocks(ranks):
        count *= min(along, 3)
    return count - 1


def ghost_part(records, ranks):
    """Ghost cells relative to the cells of a cube: one layer along each axis that is divided."""
    side = (records / OCCUPANCY) ** (1 / 3)
    held = 1
    for along in blocks(ranks):
        held *= side + (2 if along > 1 else 0)
    return held / side ** 3 - 1


def _messages(receivers, ranks):
    """The messages to a number of other ranks: none within a host. With several hosts, the model counts all
    ranks as on other hosts."""
    return 0 if ranks <= HOST_RANKS else receivers


def _transfer(records, messages):
    size = records * SENT_BYTES
    copies = size / SHARED if messages == 0 else size * (2 / PINNED + 1 / NETWORK) + messages * MESSAGE
    return FIXED + records * KERNELS + copies


def cost(records, ranks, foreign=None):
    """The costs of a rank with this number of records. `foreign` is the part that neighbours own; without
    it, cells are random."""
    is_random = foreign is None
    part = (ranks - 1) / ranks if is_random else foreign
    messages = _messages(ranks - 1 if is_random else neighbours(ranks), ranks)
    ghost_messages = 0 if is_random else _messages(neighbours(ranks), ranks)
    ghosts = 0 if is_random else records * ghost_part(records, ranks)
    sent = records * part
    return {
        "sent_bytes": sent * SENT_BYTES, "messages": messages,
        "ghost_bytes": ghosts * SENT_BYTES, "ghost_messages": ghost_messages,
        "lists_bytes": (records + ghosts) * RECORD_BYTES + records / OCCUPANCY * 4,
        "exchange_bytes": COPIES * max(sent, ghosts) * SENT_BYTES,
        "build_s": records * BUILD, "exchange_s": _transfer(sent, messages),
        "ghosts_s": 0 if is_random else records * MOVE + _transfer(ghosts, ghost_messages),
    }


def _two_digits(value):
    return f"{float(f'{value:.2g}'):,g}"


def _sent(size, messages):
    if size == 0:
        return "–"
    return f"{_two_digits(size / 1e6)} MB" + (f" in {messages:,}" if messages else "")


def _ms(seconds):
    return f"{_two_digits(1e3 * seconds)} ms" if seconds else "–"


def as_markdown():
    rows = [("records per rank", "input", "ranks", "sent by a build, in messages", "sent for ghosts, in messages",
             "memory of lists", "memory of an exchange", "time of a local build", "time of an exchange",
             "time of ghosts")]
    for title, records_of in (("2^24", lambda ranks: 2**24), ("2^26 / ranks", lambda ranks: 2**26 // ranks)):
        for name, foreign in (("particles", 0.05), ("random", None)):
            for ranks in RANKS:
                one = cost(records_of(ranks), ranks, foreign)
                rows.append((
                    title, name, f"{ranks:,}", _sent(one["sent_bytes"], one["messages"]),
                    _sent(one["ghost_bytes"], one["ghost_messages"]),
                    f"{_two_digits(one['lists_bytes'] / 1e6)} MB", f"{_two_digits(one['exchange_bytes'] / 1e6)} MB",
                    _ms(one["build_s"]), _ms(one["exchange_s"]), _ms(one["ghosts_s"])))
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join([lines[0], "|" + "---|" * len(rows[0]), *lines[1:]])
