"""Whether OpenCV's DNN module answers with an ONNX file what PyTorch answers with its definition."""

import numpy as np

from .errors import ConversionError

# Largest difference, relative to the larger of 1 and the map's largest absolute value. Where a map jumps,
# either one is up to 2e-4 away from the answer in double precision; another graph differs by tenths.
TOLERANCE = 1e-3


def images(file, size):
    """A random and a real one, [size, size, 3] RGB."""
    import cv2
    real = cv2.imread(file, cv2.IMREAD_COLOR)
    if real is None:
        raise ConversionError("%s: cannot be read as an image" % file)
    real = cv2.resize(real, (size, size), interpolation=cv2.INTER_AREA)[:, :, ::-1]
    random = np.random.RandomState(1).randint(0, 256, (size, size, 3)).astype(np.uint8)
    return (("random", random), ("real", real))


def check(onnx_bytes, run_torch, inputs, output_name, source):
    """Throws where they disagree; returns the largest relative difference. `inputs`: (name, input)."""
    import cv2
    try:
        net = cv2.dnn.readNetFromONNX(np.frombuffer(onnx_bytes, np.uint8))
    except cv2.error as error:
        raise ConversionError("OpenCV %s cannot load the converted network: %s" % (cv2.__version__, error))
    worst = 0.0
    for name, tensor in inputs:
        net.setInput(tensor)
        answer = net.forward(output_name)
        wanted = run_torch(tensor)
        if answer.shape != wanted.shape:
            raise ConversionError("%s: OpenCV's answer is %s, PyTorch's %s" % (
                source, list(answer.shape), list(wanted.shape)))
        largest = np.maximum(1, np.abs(wanted).max(axis=(2, 3), keepdims=True))
        difference = float((np.abs(answer - wanted) / largest).max())
        if not difference <= TOLERANCE:
            raise ConversionError("%s: on a %s image OpenCV %s differs from PyTorch by %g; expected at most %g"
                                  % (source, name, cv2.__version__, difference, TOLERANCE))
        worst = max(worst, difference)
    return worst
