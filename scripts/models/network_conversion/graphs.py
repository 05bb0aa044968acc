"""One network definition, two results: PyTorch's answer, or an ONNX graph.

A definition is a function that calls these operations in order. Tensors are [batch, channels, height,
width]; a bilinear resize doubles the sides with half-pixel centres (align_corners = false).
"""

import numpy as np

ACTIVATIONS = ("none", "relu", "relu6")
OPSET = 9


class TorchGraph:
    """Runs a definition at once."""

    def __init__(self, weights):
        import torch
        self._torch = torch
        self._weights = weights

    def channels(self, tensor):
        return tensor.shape[1]

    def convolution(self, tensor, name, outputs, side, stride=1, dilation=1, groups=1, activation="none"):
        torch = self._torch
        functional = torch.nn.functional
        shape = (outputs, tensor.shape[1] // groups, side, side)
        taken = self._weights.take(name, shape)
        if stride == 2:  # as the authors' framework pads: below and to the right only
            tensor = functional.pad(tensor, (0, 1, 0, 1))
            padding = 0
        else:
            padding = dilation * (side // 2)
        result = functional.conv2d(tensor, torch.from_numpy(taken.kernel), torch.from_numpy(taken.bias),
                                   stride, padding, dilation, groups)
        if activation == "relu6":
            return torch.clamp(result, 0, 6)
        return torch.relu(result) if activation == "relu" else result

    def add(self, first, second):
        return first + second

    def concatenate(self, first, second):
        return self._torch.cat((first, second), 1)

    def double_size(self, tensor):
        return self._torch.nn.functional.interpolate(tensor, scale_factor=2, mode="bilinear",
                                                     align_corners=False)


class _Tensor:
    """A value's name and shape in the graph."""

    def __init__(self, name, channels, height, width):
        self.name = name
        self.shape = (1, channels, height, width)


class OnnxGraph:
    """Writes a definition down. Only what every OpenCV from 4.2 on reads alike is used: an operator set
    whose Clip and Pad have attributes, no convolution with uneven padding, no linear Resize."""

    def __init__(self, weights):
        self._weights = weights
        self._nodes = []
        self._constants = {}
        self._names = {}

    def input(self, name, shape):
        return _Tensor(name, *shape[1:])

    def channels(self, tensor):
        return tensor.shape[1]

    def convolution(self, tensor, name, outputs, side, stride=1, dilation=1, groups=1, activation="none"):
        _, channels, height, width = tensor.shape
        taken = self._weights.take(name, (outputs, channels // groups, side, side))
        kernel = taken.kernel
        padding = dilation * (side // 2)
        if stride == 2:
            # Below and to the right only, which OpenCV's convolutions refuse.
            tensor = self._node("Pad", [tensor], name + ".pad", (channels, height + 1, width + 1),
                                mode="constant", pads=[0, 0, 0, 0, 0, 0, 1, 1], value=0.0)
            padding = 0
        result = self._node(
            "Conv", [tensor, self._constant(name + ".kernel", kernel), self._constant(name + ".bias", taken.bias)],
            name, (outputs, height // stride, width // stride), kernel_shape=list(kernel.shape[2:]),
            strides=[stride] * 2, dilations=[dilation] * 2, group=groups, pads=[padding] * 4)
        if activation == "relu":
            return self._node("Relu", [result], name + ".relu", result.shape[1:])
        if activation == "relu6":
            return self._node("Clip", [result], name + ".relu6", result.shape[1:], min=0.0, max=6.0)
        return result

    def add(self, first, second):
        return self._node("Add", [first, second], "add", first.shape[1:])

    def concatenate(self, first, second):
        shape = (first.shape[1] + second.shape[1],) + first.shape[2:]
        return self._node("Concat", [first, second], "concatenate", shape, axis=1)

    def double_size(self, tensor):
        # OpenCV's versions disagree about linear resizing in ONNX. Every pixel four times, and then
        # twice the mean of two neighbours (of one at the border), is the same to the last digit.
        _, channels, height, width = tensor.shape
        scales = self._constant("doubled", np.array([1, 1, 2, 2], np.float32))
        doubled = self._node("Upsample", [tensor, scales], "double", (channels, 2 * height, 2 * width),
                             mode="nearest")
        between = self._node("AveragePool", [doubled], "between", (channels, 2 * height + 1, 2 * width + 1),
                             kernel_shape=[2, 2], strides=[1, 1], pads=[1] * 4)
        return self._node("AveragePool", [between], "smooth", (channels, 2 * height, 2 * width),
                          kernel_shape=[2, 2], strides=[1, 1], pads=[0] * 4)

    def finish(self, network, image, output, output_name):
        """The GraphProto from `image` to `output`."""
        from onnx import TensorProto, helper
        self._nodes[-1].output[0] = output_name
        return helper.make_graph(
            self._nodes, network,
            [helper.make_tensor_value_info(image.name, TensorProto.FLOAT, image.shape)],
            [helper.make_tensor_value_info(output_name, TensorProto.FLOAT, output.shape)],
            [self._constants[name] for name in sorted(self._constants)])

    def _constant(self, name, value):
        from onnx import numpy_helper
        if name not in self._constants:
            self._constants[name] = numpy_helper.from_array(np.asarray(value), name)
        return name

    def _node(self, kind, inputs, name, shape, **attributes):
        from onnx import helper
        number = self._names[name] = self._names.get(name, 0) + 1
        unique = name if number == 1 else "%s_%d" % (name, number)
        names = [value.name if isinstance(value, _Tensor) else value for value in inputs]
        self._nodes.append(helper.make_node(kind, names, [unique], unique, **attributes))
        return _Tensor(unique, *shape)
