"""Reads MCAP files (mcap.dev/spec) and their ROS 2 messages (CDR), by the definitions in the file; written from the
specifications, apart from the program's own reader and writer."""
import ctypes
import re
import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = 1, 2, 3, 4, 5, 6, 7, 8
STATISTICS, SUMMARY_OFFSET, DATA_END = 11, 14, 15
PRIMITIVES = {"bool": "?", "byte": "B", "char": "b", "uint8": "B", "int8": "b", "uint16": "H", "int16": "h",
              "uint32": "I", "int32": "i", "uint64": "Q", "int64": "q", "float32": "f", "float64": "d"}


def unzstd(packed, size):
    library = ctypes.CDLL("libzstd.so.1")
    library.ZSTD_decompress.restype = ctypes.c_size_t
    plain = ctypes.create_string_buffer(size)
    done = library.ZSTD_decompress(plain, ctypes.c_size_t(size), packed, ctypes.c_size_t(len(packed)))
    assert done == size, "a chunk has another size than its head says"
    return plain.raw


class Fields:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, form):
        values = struct.unpack_from("<" + form, self.data, self.at)
        self.at += struct.calcsize("<" + form)
        return values[0] if len(values) == 1 else values

    def raw(self, size):
        assert self.at + size <= len(self.data)
        self.at += size
        return self.data[self.at - size:self.at]

    def text(self):
        return self.raw(self.take("I")).decode()

    def table(self, key, value):
        inner = Fields(self.raw(self.take("I")))
        found = {}
        while inner.at < len(inner.data):
            name = inner.text() if key == "text" else inner.take(key)
            found[name] = inner.text() if value == "text" else inner.take(value)
        return found


def records(data, at=0):
    """Opcode, offset, content of every complete record."""
    while at + 9 <= len(data):
        opcode, size = struct.unpack_from("<BQ", data, at)
        if at + 9 + size > len(data):
            return
        yield opcode, at, data[at + 9:at + 9 + size]
        at += 9 + size


class Mcap:
    """A file read from its start; also one that is cut off."""

    def __init__(self, data):
        assert data[:8] == MAGIC
        self.data = data
        self.schemas, self.channels, self.messages, self.chunks, self.message_indexes = {}, {}, [], [], []
        self.complete = False
        for opcode, offset, content in records(data, 8):
            self.take(opcode, offset, content)
            if opcode == DATA_END:
                self.complete = True
                self.summary_start = offset + 9 + len(content)
                break

    def take(self, opcode, offset, content):
        fields = Fields(content)
        if opcode == HEADER:
            self.profile = fields.text()
        elif opcode == SCHEMA:
            number, name, encoding = fields.take("H"), fields.text(), fields.text()
            assert encoding == "ros2msg"
            self.schemas[number] = (name, fields.raw(fields.take("I")).decode())
        elif opcode == CHANNEL:
            number, schema, topic, encoding = fields.take("H"), fields.take("H"), fields.text(), fields.text()
            assert encoding == "cdr" and "offered_qos_profiles" in fields.table("text", "text")
            self.channels[number] = (topic, schema)
        elif opcode == MESSAGE:
            channel, sequence, log_ns, publish_ns = fields.take("HIQQ")
            assert log_ns == publish_ns
            self.messages.append((channel, sequence, log_ns, content[fields.at:]))
        elif opcode == CHUNK:
            first, last, size, crc, kind = *fields.take("QQQI"), fields.text()
            assert kind == "zstd"
            plain = unzstd(fields.raw(fields.take("Q")), size)
            assert zlib.crc32(plain) == crc
            self.chunks.append((offset, 9 + len(content), first, last, plain))
            for inner in records(plain):
                self.take(*inner)
        elif opcode == MESSAGE_INDEX:
            channel = fields.take("H")
            entries = Fields(fields.raw(fields.take("I")))
            places = []
            while entries.at < len(entries.data):
                places.append(entries.take("QQ"))
            self.message_indexes.append((offset, 9 + len(content), channel, places))

    def of_topic(self, topic):
        """(sequence, time in ns, message) of a topic."""
        for channel, sequence, log_ns, data in self.messages:
            if self.channels[channel][0] == topic:
                yield sequence, log_ns, decode(*self.schemas[self.channels[channel][1]], data)

    def check_summary(self):
        """Compares index and statistics with what was read from the start."""
        assert self.complete and self.data[-8:] == MAGIC
        footer = self.data[-37:-8]
        opcode, size, start, offsets_start, crc = struct.unpack("<BQQQI", footer)
        assert (opcode, size, start) == (FOOTER, 20, self.summary_start)
        assert zlib.crc32(self.data[start:-12]) == crc
        found, groups = {}, {}
        for opcode, offset, content in records(self.data[:-37], start):
            found.setdefault(opcode, []).append(content)
            if offset < offsets_start:
                groups.setdefault(opcode, [offset, 0])[1] += 9 + len(content)
        assert set(found) == {SCHEMA, CHANNEL, STATISTICS, CHUNK_INDEX, SUMMARY_OFFSET}
        assert {c[0]: list(struct.unpack("<QQ", c[1:])) for c in found[SUMMARY_OFFSET]} == groups
        assert len(found[SCHEMA]) == len(self.schemas) and len(found[CHANNEL]) == len(self.channels)
        self.check_statistics(Fields(found[STATISTICS][0]))
        assert len(found[CHUNK_INDEX]) == len(self.chunks)
        for content, chunk in zip(found[CHUNK_INDEX], self.chunks):
            self.check_chunk_index(Fields(content), chunk)

    def check_statistics(self, fields):
        times = [message[2] for message in self.messages]
        assert fields.take("QHIIIIQQ") == (len(self.messages), len(self.schemas), len(self.channels), 0, 0,
                                           len(self.chunks), min(times), max(times))
        counts = fields.table("H", "Q")
        assert counts == {c: n for c in self.channels if (n := sum(m[0] == c for m in self.messages))}

    def check_chunk_index(self, fields, chunk):
        offset, length, first, last, plain = chunk
        assert fields.take("QQQQ") == (first, last, offset, length)
        places = fields.table("H", "Q")
        following = [i for i in self.message_indexes if offset < i[0] and i[0] in places.values()]
        assert {i[2]: i[0] for i in following} == places
        assert fields.take("Q") == sum(i[1] for i in following)
        assert (fields.text(), fields.take("QQ")[1]) == ("zstd", len(plain))
        for _, _, channel, entries in following:
            for time_ns, at in entries:
                opcode, _, message = next(records(plain, at))
                assert opcode == MESSAGE and struct.unpack_from("<HIQ", message)[::2] == (channel, time_ns)


def parse(name, text):
    """Fields (type, name, length) of every type in a definition; length: None no array, -1 any."""
    types, fields = {}, []
    types[name.replace("/msg/", "/")] = fields
    for line in text.splitlines():
        if line.startswith("MSG: "):
            fields = types.setdefault(line[5:], [])
        elif line and not line.startswith("=") and "=" not in line:
            kind, field = line.split()
            array = re.fullmatch(r"(.*)\[(\d*)\]", kind)
            fields.append((array[1], field, int(array[2] or -1)) if array else (kind, field, None))
    return types


def decode(name, text, data):
    """A message as nested dictionaries; uint8[] as bytes."""
    assert data[:4] == b"\0\1\0\0", "not CDR, little-endian"
    types, body, at = parse(name, text), data[4:], 0

    def number(form):
        nonlocal at
        size = struct.calcsize(form)
        at = -(-at // size) * size + size
        return struct.unpack_from("<" + form, body, at - size)[0]

    def value(kind):
        nonlocal at
        if kind in PRIMITIVES:
            return number(PRIMITIVES[kind])
        if kind == "string":
            size = number("I")
            at += size
            assert body[at - 1] == 0
            return body[at - size:at - 1].decode()
        return {field: array(of, length) if length is not None else value(of) for of, field, length in types[kind]}

    def array(kind, length):
        nonlocal at
        count = number("I") if length < 0 else length
        if kind == "uint8":
            at += count
            assert at <= len(body)
            return body[at - count:at]
        return [value(kind) for _ in range(count)]

    message = value(name.replace("/msg/", "/"))
    assert at == len(body), f"{name}: {len(body) - at} bytes are left"
    return message
