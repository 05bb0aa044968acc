#!/usr/bin/python3
"""The conversion of network weights (scripts/models): what it refuses, and that both forms of one
definition agree. Skipped where Python lacks PyTorch, ONNX or OpenCV."""

import inspect
import os
import pickle
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
SCRIPTS = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "scripts", "models")
sys.path.insert(0, SCRIPTS)

try:
    import cv2
    import numpy as np
    import onnx
    import torch
except ImportError as error:
    print("skipped: %s" % error)
    sys.exit(77)

from network_conversion import agreement, graphs, mlsd, pytorch_file, weights
from network_conversion.errors import ConversionError

SIZE = 64


def random_convolutions(variant, channels=4, maps=16):
    """Weights of a whole network as a checkpoint has them, small enough not to grow."""
    random = np.random.RandomState(2)
    found = {}
    for name, shape, *_ in mlsd.convolutions_in_order(variant):
        outputs, inputs, height, width = shape
        if name == "backbone.features.0.0":
            inputs = channels
        if name.endswith(".conv3"):
            outputs = maps
        kernel = random.normal(0, 1 / np.sqrt(inputs * height * width), (outputs, inputs, height, width))
        if name == "backbone.features.0.0" and channels == 4:
            kernel[:, 3] = 0
        found[name] = weights.Convolution(kernel, random.normal(0, 0.1, outputs))
    return found


def as_state_dict(convolutions):
    """As the PyTorch port writes them: a bare kernel and a norm that shifts, or kernel and bias."""
    tensors = {}
    for name, one in convolutions.items():
        tensors[name + ".weight"] = torch.from_numpy(one.kernel)
        head, _, number = name.rpartition(".")
        if not number.isdigit():
            tensors[name + ".bias"] = torch.from_numpy(one.bias)
            continue
        norm = "%s.%d" % (head, int(number) + 1)
        tensors[norm + ".weight"] = torch.ones(len(one.bias))
        tensors[norm + ".bias"] = torch.zeros(len(one.bias))
        tensors[norm + ".running_mean"] = -torch.from_numpy(one.bias)
        tensors[norm + ".running_var"] = torch.ones(len(one.bias))
        tensors[norm + ".num_batches_tracked"] = torch.tensor([0])
    return tensors


def run_convert(*arguments):
    return subprocess.run([sys.executable, os.path.join(SCRIPTS, "convert"), "mlsd", *arguments],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)


class Definition(unittest.TestCase):
    def test_both_variants_end_in_five_maps_of_half_the_size(self):
        for variant in mlsd.VARIANTS:
            taken = mlsd.select_maps(random_convolutions(variant), "test", variant)
            image = torch.zeros((1, 3, SIZE, SIZE))
            with torch.no_grad():
                maps = mlsd.define(graphs.TorchGraph(taken), image, variant)
            taken.finish()
            self.assertEqual(tuple(maps.shape), (1, 5, SIZE // 2, SIZE // 2))

    def test_doubling_is_that_of_half_pixel_centres(self):
        graph = graphs.OnnxGraph(None)
        image = graph.input("image", (1, 2, 3, 5))
        doubled = graph.double_size(image)
        model = onnx.helper.make_model(graph.finish("test", image, doubled, "maps"),
                                       opset_imports=[onnx.helper.make_opsetid("", graphs.OPSET)])
        onnx.checker.check_model(model)
        net = cv2.dnn.readNetFromONNX(np.frombuffer(model.SerializeToString(), np.uint8))
        values = np.random.RandomState(1).normal(size=(1, 2, 3, 5)).astype(np.float32)
        net.setInput(values)
        wanted = graphs.TorchGraph(None).double_size(torch.from_numpy(values)).numpy()
        np.testing.assert_allclose(net.forward("maps"), wanted, atol=1e-6)

    def test_a_disagreement_is_refused(self):
        graph = graphs.OnnxGraph(None)
        image = graph.input("image", (1, 2, 4, 4))
        model = onnx.helper.make_model(graph.finish("test", image, graph.add(image, image), "maps"),
                                       opset_imports=[onnx.helper.make_opsetid("", graphs.OPSET)])
        inputs = [("random", np.ones((1, 2, 4, 4), np.float32))]
        agreement.check(model.SerializeToString(), lambda x: 2 * x, inputs, "maps", "test")
        with self.assertRaisesRegex(ConversionError, "differs from PyTorch by"):
            agreement.check(model.SerializeToString(), lambda x: 2.01 * x, inputs, "maps", "test")


class Checkpoints(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.output = os.path.join(self.folder, "mlsd.onnx")

    def save(self, tensors):
        file = os.path.join(self.folder, "mlsd.pth")
        torch.save(tensors, file)
        return file

    def refused(self, file, *parts):
        result = run_convert("--checkpoint", file, "--output", self.output, "--size", str(SIZE))
        self.assertEqual(result.returncode, 1, result.stderr)
        for part in parts:
            self.assertIn(part, result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        self.assertFalse(os.path.exists(self.output))

    def test_a_checkpoint_becomes_a_file_that_says_its_sum(self):
        file = self.save(as_state_dict(random_convolutions("tiny")))
        result = run_convert("--checkpoint", file, "--output", self.output, "--size", str(SIZE))
        self.assertEqual(result.returncode, 0, result.stderr)
        model = onnx.load(self.output)
        self.assertEqual(model.metadata_props[0].key, "evolin.graph_sha256")
        self.assertEqual([side.dim_value for side in model.graph.input[0].type.tensor_type.shape.dim],
                         [1, 3, SIZE, SIZE])
        again = run_convert("--checkpoint", file, "--output", self.output, "--size", str(SIZE))
        self.assertEqual(again.returncode, 1)
        self.assertIn("--force", again.stderr)

    def test_missing_surplus_and_reshaped_tensors_are_listed(self):
        tensors = as_state_dict(random_convolutions("tiny"))
        del tensors["block12.conv1.0.weight"]
        for part in pytorch_file.NORM + ("num_batches_tracked",):
            del tensors["block12.conv1.1." + part]
        tensors["block99.conv1.weight"] = torch.zeros((1, 1, 1, 1))
        tensors["block13.conv1.0.weight"] = torch.zeros((128, 128, 1, 1))
        self.refused(self.save(tensors), "another network", "missing: block12.conv1.0",
                     "surplus: block99.conv1", "block13.conv1.0 has the kernel [128, 128, 1, 1]")

    def test_norms_that_scale_are_refused(self):
        tensors = as_state_dict(random_convolutions("tiny"))
        tensors["block13.conv1.1.running_var"] *= 2
        self.refused(self.save(tensors), "batch norm block13.conv1.1 scales")

    def test_a_fourth_channel_that_counts_is_refused(self):
        convolutions = random_convolutions("tiny")
        convolutions["backbone.features.0.0"].kernel[0, 3, 0, 0] = 1e-3
        self.refused(self.save(as_state_dict(convolutions)), "fourth channel")

    def test_values_that_are_not_finite_are_refused(self):
        convolutions = random_convolutions("tiny")
        convolutions["block13.conv1.0"].kernel[0, 0, 0, 0] = np.nan
        self.refused(self.save(as_state_dict(convolutions)), "block13.conv1.0 holds values that are not finite")

    def test_other_files_are_refused(self):
        for name, content in (("a.pth", b"no checkpoint"), ("b.tflite", b"no file"),
                              ("c.tflite", b"\x08\x00\x00\x00TFL3" + bytes(range(200)))):
            file = os.path.join(self.folder, name)
            with open(file, "wb") as stream:
                stream.write(content)
            self.refused(file, name)
        self.refused(os.path.join(self.folder, "none.pth"), "there is no such file")

    def test_a_checkpoint_that_would_run_code_is_refused_without_running_it(self):
        if "weights_only" not in inspect.signature(torch.load).parameters:
            self.skipTest("PyTorch before 1.13 unpickles everything")
        written = os.path.join(self.folder, "written")
        run = b"cbuiltins\nopen\n(V" + written.encode() + b"\nVw\ntR0"
        # An unpickler of tensors alone fails on this state with a TypeError; the full one takes it.
        confusing = b"ccollections\nOrderedDict\n)R(N}tb"
        file = os.path.join(self.folder, "hostile.pth")
        with open(file, "wb") as stream:
            stream.write(b"\x80\x02" + confusing + run + b".")
        self.refused(file, "hostile.pth: is no PyTorch checkpoint")
        self.assertFalse(os.path.exists(written), "code of the checkpoint has run")
        with open(file, "rb") as stream:
            pickle.load(stream)
        self.assertTrue(os.path.exists(written), "the checkpoint is harmless: it tests nothing")

    def test_sizes_that_the_network_cannot_have_are_refused(self):
        file = self.save(as_state_dict(random_convolutions("tiny")))
        result = run_convert("--checkpoint", file, "--output", self.output, "--size", "100")
        self.assertEqual(result.returncode, 1)
        self.assertIn("multiple of 32", result.stderr)


if __name__ == "__main__":
    unittest.main()
