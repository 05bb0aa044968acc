"""M-LSD's two networks (Gu, Ko, Go, Lee, Lee, Shin: Towards Light-weight and Real-time Line Segment
Detection, AAAI 2022), as the authors' files have them.

The well-known PyTorch port has the same weights in another graph (it resizes after the convolutions and
with aligned corners); its tensor names are used here, its graph is not.
"""

import numpy as np

from .errors import ConversionError
from .weights import Convolution, Weights

# Of MobileNetV2: expansion, channels, blocks, stride of the first.
STAGES = ((1, 16, 1, 1), (6, 24, 2, 2), (6, 32, 3, 2), (6, 64, 4, 2), (6, 96, 3, 1))
VARIANTS = {
    # Number of backbone blocks; blocks whose outputs go on, the deepest first; channels that each of the
    # two branches of an up-block gets; number of the first up-block; whether the maps are doubled.
    "tiny": dict(blocks=10, taps=(10, 6, 3), branches=(64, 32), first=12, doubled=True),
    "large": dict(blocks=13, taps=(13, 10, 6, 3, 1), branches=(64, 64, 64, 64), first=15, doubled=False),
}
INPUT = "image"
OUTPUT = "maps"
# Of the 16 channels: the logit of a centre and the displacements of the ends.
CHANNELS = slice(7, 12)
DEFAULT_SIZE = 512


def prepare(pixels):
    """[height, width, 3] RGB, 0 to 255, to the network's input."""
    scaled = pixels.astype(np.float32) / np.float32(127.5) - np.float32(1)
    return np.ascontiguousarray(scaled.transpose(2, 0, 1)[None])


def check_size(size):
    if size < 64 or size > 4096 or size % 32 != 0:
        raise ConversionError("--size: is %d; expected a multiple of 32 from 64 to 4096" % size)


def define(graph, image, variant):
    """The network's [1, 5, size / 2, size / 2] maps."""
    parts = VARIANTS[variant]
    outputs = _backbone(graph, image, parts["blocks"])
    deep = outputs[parts["taps"][0]]
    number = parts["first"]
    for tap, branch in zip(parts["taps"][1:], parts["branches"]):
        skip = outputs[tap]
        name = "block%d" % number
        # Between blocks of one resolution nothing is resized.
        if not (variant == "large" and tap == 10):
            deep = graph.double_size(deep)
        deep = graph.convolution(deep, name + ".conv1.0", branch, 1, activation="relu")
        skip = graph.convolution(skip, name + ".conv2.0", branch, 1, activation="relu")
        deep = _refine(graph, graph.concatenate(skip, deep), "block%d" % (number + 1))
        number += 2
    name = "block%d" % number
    deep = graph.convolution(deep, name + ".conv1.0", 64, 3, dilation=5, activation="relu")
    deep = graph.convolution(deep, name + ".conv2.0", 64, 3, activation="relu")
    maps = graph.convolution(deep, name + ".conv3", CHANNELS.stop - CHANNELS.start, 1)
    return graph.double_size(maps) if parts["doubled"] else maps


def _refine(graph, tensor, name):
    same = graph.convolution(tensor, name + ".conv1.0", graph.channels(tensor), 3, activation="relu")
    return graph.convolution(graph.add(same, tensor), name + ".conv2.0", 64, 3, activation="relu")


def _backbone(graph, image, blocks):
    """Outputs of the blocks by their number; 0 is the first convolution."""
    tensor = graph.convolution(image, "backbone.features.0.0", 32, 3, stride=2, activation="relu6")
    outputs = {0: tensor}
    for expansion, channels, repeats, first_stride in STAGES:
        for repeat in range(repeats):
            if len(outputs) > blocks:
                return outputs
            number = len(outputs)
            stride = first_stride if repeat == 0 else 1
            tensor = _inverted_residual(graph, tensor, "backbone.features.%d.conv" % number, expansion,
                                        channels, stride)
            outputs[number] = tensor
    return outputs


def _inverted_residual(graph, tensor, name, expansion, channels, stride):
    hidden = graph.channels(tensor) * expansion
    result = tensor
    parts = iter((name + ".0.0", name + ".1") if expansion == 1 else (name + ".0.0", name + ".1.0", name + ".2"))
    if expansion != 1:
        result = graph.convolution(result, next(parts), hidden, 1, activation="relu6")
    result = graph.convolution(result, next(parts), hidden, 3, stride=stride, groups=hidden, activation="relu6")
    result = graph.convolution(result, next(parts), channels, 1)
    return graph.add(tensor, result) if stride == 1 and graph.channels(tensor) == channels else result


def variant_of(names):
    """Which of the two a checkpoint with tensors of these names holds."""
    return "large" if any(name.startswith("block23.") for name in names) else "tiny"


def select_maps(convolutions, source, variant):
    """Leaves the five maps of the sixteen, and drops the input's fourth channel: it is always one, and
    its weights are zero."""
    first = convolutions.get("backbone.features.0.0")
    if first is not None and first.kernel.ndim == 4 and first.kernel.shape[1] == 4:
        if first.kernel[:, 3].any():
            raise ConversionError("%s: the weights of the input's fourth channel are not zero, as they are in "
                                  "all published files" % source)
        convolutions["backbone.features.0.0"] = Convolution(first.kernel[:, :3], first.bias)
    parts = VARIANTS[variant]
    name = "block%d.conv3" % (parts["first"] + 2 * len(parts["branches"]))
    last = convolutions.get(name)
    if last is not None and len(last.kernel) == 16:
        convolutions[name] = Convolution(last.kernel[CHANNELS], last.bias[CHANNELS])
    return Weights(source, convolutions)


class Recorder:
    """A graph that only notes the convolutions of a definition, in their order."""

    def __init__(self):
        self.calls = []

    def channels(self, tensor):
        return tensor

    def convolution(self, tensor, name, outputs, side, stride=1, dilation=1, groups=1, activation="none"):
        self.calls.append((name, (outputs, tensor // groups, side, side), stride, dilation, groups, activation))
        return outputs

    def add(self, first, second):
        return first

    def concatenate(self, first, second):
        return first + second

    def double_size(self, tensor):
        return tensor


def convolutions_in_order(variant):
    """What the definition asks for: name, kernel's shape, stride, dilation, groups, activation."""
    recorder = Recorder()
    define(recorder, 3, variant)
    return recorder.calls
