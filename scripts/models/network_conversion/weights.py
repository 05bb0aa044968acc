"""The weights of a network as its definition asks for them, and that nothing is missing or left over."""

import numpy as np

from .errors import ConversionError


class Convolution:
    """Kernel [outputs, inputs / groups, height, width] and bias [outputs], float32."""

    def __init__(self, kernel, bias):
        self.kernel = np.ascontiguousarray(kernel, np.float32)
        self.bias = np.ascontiguousarray(bias, np.float32)


class Weights:
    """Convolutions by name; each is taken once, and finish() refuses what nobody took."""

    def __init__(self, source, convolutions):
        self.source = source
        self._left = dict(convolutions)
        self._faults = []

    def take(self, name, shape):
        """The convolution of that name, or zeros where it is missing or of another shape (which
        finish() tells)."""
        found = self._left.pop(name, None)
        if found is None:
            self._faults.append("missing: %s %s" % (name, list(shape)))
        elif found.kernel.shape != tuple(shape) or found.bias.shape != (shape[0],):
            self._faults.append("%s has the kernel %s and the bias %s; expected %s and %s" % (
                name, list(found.kernel.shape), list(found.bias.shape), list(shape), [shape[0]]))
        elif not (np.isfinite(found.kernel).all() and np.isfinite(found.bias).all()):
            self._faults.append("%s holds values that are not finite" % name)
        else:
            return found
        return Convolution(np.zeros(shape), np.zeros(shape[0]))

    def finish(self):
        faults = self._faults + ["surplus: %s %s" % (name, list(left.kernel.shape))
                                 for name, left in self._left.items()]
        if faults:
            raise ConversionError("%s: holds another network:\n  %s" % (self.source, "\n  ".join(faults)))
