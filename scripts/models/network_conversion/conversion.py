"""From a checkpoint to a checked ONNX file."""

import hashlib
import os

from . import agreement, mlsd, pytorch_file, tflite_file
from .errors import ConversionError
from .graphs import OPSET, OnnxGraph, TorchGraph

IMAGE = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "..", "docs", "images", "lines.jpg")


def convert(options):
    """Writes options.output and returns what to print."""
    variant, size, convolutions = _read(options)
    mlsd.check_size(size)

    def weights():
        return mlsd.select_maps(dict(convolutions), options.checkpoint, variant)

    content = _onnx(weights(), variant, size)
    inputs = [(name, mlsd.prepare(pixels)) for name, pixels in agreement.images(options.image or IMAGE, size)]
    worst = agreement.check(content, lambda image: _run(weights(), image, variant), inputs, mlsd.OUTPUT,
                            options.checkpoint)
    _write(options.output, content)
    return "%s: M-LSD %s, input %d x %d, SHA-256 %s; OpenCV's answers are PyTorch's within %.1e (at most %g)" % (
        options.output, variant, size, size, hashlib.sha256(content).hexdigest(), worst, agreement.TOLERANCE)


def _read(options):
    """Variant, side of the input, convolutions by name."""
    file = options.checkpoint
    if not os.path.isfile(file):
        raise ConversionError("%s: there is no such file" % file)
    if file.endswith(".tflite"):
        tflite = tflite_file.TfliteFile(file)
        large = len(mlsd.convolutions_in_order("large"))
        variant = "large" if len(tflite.convolutions) == large else "tiny"
        expected = [_with_all_maps(call) for call in mlsd.convolutions_in_order(variant)]
        return variant, options.size or tflite.size, tflite_file.convolutions(tflite, expected, file)
    tensors = pytorch_file.read(file)
    return (mlsd.variant_of(tensors), options.size or mlsd.DEFAULT_SIZE,
            pytorch_file.convolutions(tensors, file))


def _with_all_maps(call):
    """Of the definition's shapes, the first and the last differ from the file's: see select_maps()."""
    name, (outputs, inputs, height, width) = call[:2]
    if name == "backbone.features.0.0":
        inputs = 4
    elif name.endswith(".conv3"):
        outputs = 16
    return (name, (outputs, inputs, height, width)) + tuple(call[2:])


def _onnx(weights, variant, size):
    from onnx import checker, helper
    graph = OnnxGraph(weights)
    image = graph.input(mlsd.INPUT, (1, 3, size, size))
    maps = mlsd.define(graph, image, variant)
    weights.finish()
    proto = graph.finish("mlsd_" + variant, image, maps, mlsd.OUTPUT)
    model = helper.make_model(proto, producer_name="evolin_ros", opset_imports=[helper.make_opsetid("", OPSET)])
    model.ir_version = 4
    # By this sum the detector knows that the file is whole.
    helper.set_model_props(model, {"evolin.graph_sha256": hashlib.sha256(proto.SerializeToString()).hexdigest()})
    checker.check_model(model)
    return model.SerializeToString()


def _run(weights, image, variant):
    import torch
    with torch.no_grad():
        maps = mlsd.define(TorchGraph(weights), torch.from_numpy(image), variant)
    weights.finish()
    return maps.numpy()


def _write(file, content):
    """As a whole or not at all."""
    folder = os.path.dirname(os.path.abspath(file))
    os.makedirs(folder, exist_ok=True)
    temporary = os.path.join(folder, ".%s.tmp-%d" % (os.path.basename(file), os.getpid()))
    try:
        with open(temporary, "wb") as stream:
            stream.write(content)
        os.replace(temporary, file)
    finally:
        if os.path.exists(temporary):
            os.remove(temporary)
