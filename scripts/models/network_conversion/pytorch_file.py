"""Convolutions of a PyTorch state dict, with the batch norms behind them folded in."""

import inspect

import numpy as np

from .errors import ConversionError
from .weights import Convolution

NORM = ("weight", "bias", "running_mean", "running_var")


def read(file):
    """Tensors by name, as numpy arrays. From PyTorch 1.13 on nothing but tensors is unpickled; before
    that, reading a checkpoint runs whatever code it holds."""
    import torch
    knows = "weights_only" in inspect.signature(torch.load).parameters
    safely = {"weights_only": True} if knows else {}
    try:
        content = torch.load(file, map_location="cpu", **safely)
    except Exception as error:  # damage makes an unpickler raise anything
        raise ConversionError("%s: is no PyTorch checkpoint, or damaged: %s" % (file, error))
    if isinstance(content, dict) and isinstance(content.get("state_dict"), dict):
        content = content["state_dict"]
    if not isinstance(content, dict) or not all(hasattr(value, "numpy") for value in content.values()):
        raise ConversionError("%s: expected a dictionary of tensors" % file)
    return {name: value.numpy() for name, value in content.items()}


def convolutions(tensors, source):
    """Folds every batch norm into the convolution before it. In published files of networks whose norms
    were folded already, a norm is a shift alone; another one is refused, as its epsilon is not known."""
    found = {}
    left = dict(tensors)
    for name in [name for name, value in tensors.items() if name.endswith(".weight") and value.ndim == 4]:
        key = name[:-len(".weight")]
        kernel = left.pop(name)
        bias = left.pop(key + ".bias", np.zeros(len(kernel), np.float32))
        norm = _following(key)
        if all("%s.%s" % (norm, part) in left for part in NORM):
            scale, shift, mean, variance = (left.pop("%s.%s" % (norm, part)) for part in NORM)
            left.pop(norm + ".num_batches_tracked", None)
            if not (np.all(scale == 1) and np.all(variance == 1)):
                raise ConversionError("%s: the batch norm %s scales; expected one that was folded into its "
                                      "convolution and only shifts" % (source, norm))
            bias = bias - mean + shift
        found[key] = Convolution(kernel, bias)
    if left:
        raise ConversionError("%s: holds another network:\n  %s" % (source, "\n  ".join(
            "surplus: %s %s" % (name, list(value.shape)) for name, value in left.items())))
    return found


def _following(key):
    """The layer behind "a.b.0" is "a.b.1"."""
    head, _, number = key.rpartition(".")
    return "%s.%d" % (head, int(number) + 1) if number.isdigit() else key + ".norm"
