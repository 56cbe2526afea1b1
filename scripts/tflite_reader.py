# SPDX-License-Identifier: Apache-2.0
"""Reads a TensorFlow Lite model: a flatbuffer of tensors and a list of operators.

Only what the face networks use of the schema (tensorflow/lite/schema/schema.fbs, version 3); an
operator outside the table below is refused by name or number.
"""

import struct
from dataclasses import dataclass

import numpy as np

OPERATORS = {
    0: "ADD", 2: "CONCATENATION", 3: "CONV_2D", 4: "DEPTHWISE_CONV_2D", 6: "DEQUANTIZE",
    17: "MAX_POOL_2D", 19: "RELU", 22: "RESHAPE", 34: "PAD", 54: "PRELU",
}

# Options by operator: (field number, struct format, default), as in the schema's tables.
OPTIONS = {
    "ADD": {"activation": (0, "b", 0)},
    "CONCATENATION": {"axis": (0, "i", 0), "activation": (1, "b", 0)},
    "CONV_2D": {"padding": (0, "b", 0), "stride_w": (1, "i", 0), "stride_h": (2, "i", 0),
                "activation": (3, "b", 0), "dilation_w": (4, "i", 1), "dilation_h": (5, "i", 1)},
    "DEPTHWISE_CONV_2D": {"padding": (0, "b", 0), "stride_w": (1, "i", 0), "stride_h": (2, "i", 0),
                          "depth_multiplier": (3, "i", 0), "activation": (4, "b", 0),
                          "dilation_w": (5, "i", 1), "dilation_h": (6, "i", 1)},
    "MAX_POOL_2D": {"padding": (0, "b", 0), "stride_w": (1, "i", 0), "stride_h": (2, "i", 0),
                    "filter_w": (3, "i", 0), "filter_h": (4, "i", 0), "activation": (5, "b", 0)},
}

TYPES = {0: np.float32, 1: np.float16, 2: np.int32}


class FormatError(Exception):
    """The bytes are not a model of the kind that this reader knows."""


class _Table:
    """A flatbuffer table: fields by number, absent ones as their default."""

    def __init__(self, data, position):
        self.data = data
        self.position = position
        self.vtable = position - self._unpack("i", position)
        self.vtable_size = self._unpack("H", self.vtable)

    def _unpack(self, code, position):
        return struct.unpack_from("<" + code, self.data, position)[0]

    def _field(self, number):
        entry = 4 + 2 * number
        if entry >= self.vtable_size:
            return 0
        offset = self._unpack("H", self.vtable + entry)
        return self.position + offset if offset else 0

    def scalar(self, number, code, default=0):
        field = self._field(number)
        return self._unpack(code, field) if field else default

    def table(self, number):
        field = self._field(number)
        return _Table(self.data, field + self._unpack("I", field)) if field else None

    def _vector(self, number):
        field = self._field(number)
        if not field:
            return 0, 0
        start = field + self._unpack("I", field)
        return start + 4, self._unpack("I", start)

    def array(self, number, dtype):
        start, count = self._vector(number)
        return np.frombuffer(self.data, dtype, count, start)

    def tables(self, number):
        start, count = self._vector(number)
        places = range(start, start + 4 * count, 4)
        return [_Table(self.data, place + self._unpack("I", place)) for place in places]

    def string(self, number):
        return self.array(number, np.uint8).tobytes().decode()


@dataclass
class Tensor:
    name: str
    shape: tuple
    constant: np.ndarray  # None when computed


@dataclass
class Operator:
    kind: str
    inputs: list   # tensor numbers
    outputs: list
    options: dict


@dataclass
class Model:
    tensors: list
    inputs: list
    outputs: list
    operators: list  # DEQUANTIZE of constants already done


def _read_tensor(table, buffers):
    shape = tuple(int(n) for n in table.array(0, np.int32))
    raw = buffers[table.scalar(2, "I")].array(0, np.uint8)
    code = table.scalar(1, "b")
    if raw.size and code not in TYPES:
        raise FormatError(f"tensor {table.string(3)}: type {code} is not supported")
    constant = raw.view(TYPES[code]).reshape(shape) if raw.size else None
    return Tensor(table.string(3), shape, constant)


def _read_operator(table, codes):
    code = codes[table.scalar(0, "I")]
    number = max(code.scalar(0, "b"), code.scalar(3, "i"))
    if number not in OPERATORS:
        raise FormatError(f"operator {code.string(1) or number} is not supported")
    kind = OPERATORS[number]
    options = table.table(4)
    values = {}
    for name, (field, fmt, default) in OPTIONS.get(kind, {}).items():
        values[name] = options.scalar(field, fmt, default) if options else default
    return Operator(kind, table.array(1, np.int32).tolist(), table.array(2, np.int32).tolist(),
                    values)


def read_model(data):
    """The model in `data` (bytes), with float16 constants widened to float32."""
    if data[4:8] != b"TFL3":
        raise FormatError("not a TensorFlow Lite model of version 3")
    root = _Table(data, struct.unpack_from("<I", data, 0)[0])
    codes, graphs, buffers = root.tables(1), root.tables(2), root.tables(4)
    if len(graphs) != 1:
        raise FormatError(f"got {len(graphs)} graphs, want 1")
    graph = graphs[0]
    tensors = [_read_tensor(t, buffers) for t in graph.tables(0)]
    operators = []
    for table in graph.tables(3):
        operator = _read_operator(table, codes)
        source = tensors[operator.inputs[0]]
        if operator.kind == "DEQUANTIZE" and source.constant is not None:
            tensors[operator.outputs[0]].constant = source.constant.astype(np.float32)
        else:
            operators.append(operator)
    return Model(tensors, graph.array(1, np.int32).tolist(), graph.array(2, np.int32).tolist(),
                 operators)
