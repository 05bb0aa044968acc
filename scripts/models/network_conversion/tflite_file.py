"""Convolutions of a TFLite file, read with the FlatBuffers library; field numbers are those of the
published schema."""

import struct

import numpy as np

from .errors import ConversionError
from .weights import Convolution

CONV_2D, DEPTHWISE_CONV_2D, DEQUANTIZE, RESIZE_BILINEAR = 3, 4, 6, 23
ACTIVATIONS = {0: "none", 1: "relu", 3: "relu6"}
TYPES = {0: np.dtype("<f4"), 1: np.dtype("<f2"), 2: np.dtype("<i4"), 4: np.dtype("<i8")}


class _Table:
    """A FlatBuffers table by field numbers."""

    def __init__(self, data, position):
        from flatbuffers.table import Table
        self._table = Table(data, position)
        self._data = data

    def number(self, field, kind="<i", default=0):
        offset = self._table.Offset(4 + 2 * field)
        return struct.unpack_from(kind, self._data, offset + self._table.Pos)[0] if offset else default

    def table(self, field):
        offset = self._table.Offset(4 + 2 * field)
        return _Table(self._data, self._table.Indirect(offset + self._table.Pos)) if offset else None

    def tables(self, field):
        offset = self._table.Offset(4 + 2 * field)
        if not offset:
            return []
        begin = self._table.Vector(offset)
        return [_Table(self._data, self._table.Indirect(begin + 4 * i))
                for i in range(self._table.VectorLen(offset))]

    def array(self, field, kind="<i4"):
        offset = self._table.Offset(4 + 2 * field)
        if not offset:
            return np.zeros(0, kind)
        return np.frombuffer(self._data, kind, self._table.VectorLen(offset), self._table.Vector(offset))


class TfliteConvolution:
    """One convolution of the file, its kernel as PyTorch has it."""

    def __init__(self, weights, shape, stride, dilation, groups, activation):
        self.weights = weights
        self.shape = shape
        self.stride = stride
        self.dilation = dilation
        self.groups = groups
        self.activation = activation


class TfliteFile:
    """The convolutions in their order, and the side of the square input."""

    def __init__(self, file):
        try:
            with open(file, "rb") as stream:
                data = stream.read()
            if data[4:8] != b"TFL3":
                raise ConversionError("%s: is no TFLite file" % file)
            self._read(data)
        except (struct.error, ValueError, IndexError, KeyError, TypeError, AttributeError) as error:
            raise ConversionError("%s: is no whole TFLite file: %s" % (file, error))

    def _read(self, data):
        model = _Table(data, struct.unpack_from("<I", data, 0)[0])
        codes = [max(code.number(0, "<b"), code.number(3)) for code in model.tables(1)]
        graph = model.tables(2)[0]
        self._tensors = graph.tables(0)
        self._buffers = model.tables(4)
        self._widened = {}
        self.convolutions = []
        self.half_pixel = True
        self.size = int(self._tensors[graph.array(1)[0]].array(0)[1])
        for operator in graph.tables(3):
            code = codes[operator.number(0, "<I")]
            inputs = operator.array(1)
            if code == DEQUANTIZE:
                self._widened[int(operator.array(2)[0])] = int(inputs[0])
            elif code in (CONV_2D, DEPTHWISE_CONV_2D):
                self.convolutions.append(self._convolution(code, inputs, operator.table(4)))
            elif code == RESIZE_BILINEAR:
                options = operator.table(4)
                self.half_pixel &= options.number(2, "<b") == 0 and options.number(3, "<b") == 1

    def _convolution(self, code, inputs, options):
        kernel = self._values(int(inputs[1]))
        bias = self._values(int(inputs[2]))
        if code == CONV_2D:  # [outputs, height, width, inputs]
            kernel = kernel.transpose(0, 3, 1, 2)
            groups, activation, dilation = 1, options.number(3, "<b"), options.number(4, default=1)
        else:  # [1, height, width, channels]
            kernel = kernel.transpose(3, 0, 1, 2)
            groups, activation, dilation = len(kernel), options.number(4, "<b"), options.number(5, default=1)
        return TfliteConvolution(Convolution(kernel, bias), kernel.shape, options.number(1), dilation, groups,
                                 ACTIVATIONS.get(activation, "another"))

    def _values(self, number):
        tensor = self._tensors[self._widened.get(number, number)]
        kind = TYPES[tensor.number(1, "<b")]
        raw = self._buffers[tensor.number(2, "<I")].array(0, "<u1")
        return np.frombuffer(raw.tobytes(), kind).reshape(tuple(tensor.array(0))).astype(np.float32)


def convolutions(tflite, expected, source):
    """The file's convolutions under the definition's names; `expected` is convolutions_in_order()."""
    if not tflite.half_pixel:
        raise ConversionError("%s: resizes otherwise than with half-pixel centres" % source)
    faults = []
    found = {}
    for number in range(max(len(expected), len(tflite.convolutions))):
        wanted = _text(*expected[number][1:]) if number < len(expected) else "none"
        have = "none"
        if number < len(tflite.convolutions):
            one = tflite.convolutions[number]
            have = _text(one.shape, one.stride, one.dilation, one.groups, one.activation)
            if number < len(expected):
                found[expected[number][0]] = one.weights
        if have != wanted:
            faults.append("convolution %d is %s; expected %s" % (number, have, wanted))
    if faults:
        raise ConversionError("%s: holds another network:\n  %s" % (source, "\n  ".join(faults)))
    return found


def _text(shape, stride, dilation, groups, activation):
    return "%s, stride %d, dilation %d, groups %d, %s" % (list(shape), stride, dilation, groups, activation)
