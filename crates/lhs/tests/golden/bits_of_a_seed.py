"""The golden values of tests/latin.rs, from the definitions alone.

    python3 crates/lhs/tests/golden/bits_of_a_seed.py

Whole numbers and IEEE doubles only, no package: ChaCha8 (Bernstein 2008; the
layout of RFC 7539 with a 64-bit counter and a 64-bit stream number), Lemire's
bounded integers, Fisher-Yates up to 4096 points, an eight-round Feistel network
with cycle walking above, SplitMix64 for the place in the stratum. Checked with
Python 3.11.
"""

import struct

M32, M64 = (1 << 32) - 1, (1 << 64) - 1


def quarter(x, a, b, c, d):
    for p, q, r, turn in ((a, b, d, 16), (c, d, b, 12), (a, b, d, 8), (c, d, b, 7)):
        x[p] = (x[p] + x[q]) & M32
        word = x[r] ^ x[p]
        x[r] = (word << turn | word >> (32 - turn)) & M32


def chacha8(key, stream):
    """64-bit words, low half first."""
    counter = 0
    while True:
        start = list(struct.unpack("<4I", b"expand 32-byte k")) + list(struct.unpack("<8I", key))
        start += [counter & M32, counter >> 32, stream & M32, stream >> 32]
        x = start[:]
        for _ in range(4):
            for i in range(4):
                quarter(x, i, 4 + i, 8 + i, 12 + i)
            for i in range(4):
                quarter(x, i, 4 + (i + 1) % 4, 8 + (i + 2) % 4, 12 + (i + 3) % 4)
        words = [(a + b) & M32 for a, b in zip(x, start)]
        for low, high in zip(words[::2], words[1::2]):
            yield high << 32 | low
        counter += 1


def below(words, bound):
    while True:
        wide = next(words) * bound
        if wide & M64 >= (1 << 64) % bound:
            return wide >> 64


class Column:
    def __init__(self, n, seed, dim):
        words = chacha8(struct.pack("<4Q", seed, 1, 0, 0), dim)
        self.n, self.jitter = n, next(words)
        if n <= 4096:
            self.table = list(range(n))
            for i in range(n - 1, 0, -1):
                j = below(words, i + 1)
                self.table[i], self.table[j] = self.table[j], self.table[i]
        else:
            self.table = None
            bits = (n - 1).bit_length()
            self.low = bits - bits // 2
            self.high_mask = (1 << bits // 2) - 1
            self.keys = [(next(words), next(words) | 1) for _ in range(8)]

    def cell(self, x):
        if self.table:
            return self.table[x]
        low_mask = (1 << self.low) - 1
        while True:
            low, high = x & low_mask, x >> self.low
            for k, (mask, factor) in enumerate(self.keys):
                if k % 2 == 0:
                    high ^= ((low ^ mask) * factor & M64) >> 32 & self.high_mask
                else:
                    low ^= ((high ^ mask) * factor & M64) >> 32 & low_mask
            x = high << self.low | low
            if x < self.n:
                return x

    def value(self, row):
        z = self.jitter + (row + 1) * 0x9E3779B97F4A7C15 & M64
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 & M64
        z = (z ^ z >> 27) * 0x94D049BB133111EB & M64
        bits = z ^ z >> 31
        edge = 4.0 * self.n * 2.0**-53
        u = edge + (1.0 - 2.0 * edge) * ((bits >> 11) * 2.0**-53)
        return (self.cell(row) + u) / self.n


def columns(n):
    return [Column(n, 42, dim) for dim in (0, 1)]


for name, n in (("GOLDEN_SMALL", 10), ("GOLDEN_LARGE", 1_000_000)):
    pair = columns(n)
    print(name, [pair[i % 2].cell(i // 2) for i in range(8)])
print("GOLDEN_ROW", [struct.unpack("<Q", struct.pack("<d", c.value(3)))[0] for c in columns(1_000_000)])
