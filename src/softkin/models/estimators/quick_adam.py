"""Adam on the squared error of a network, equal to scikit-learn's to the bit, over arrays that are made once.

scikit-learn's steps handle the parameters of each layer by themselves, check every array that they multiply, and make a
new one of each result: on batches of 200 rows that took longer than the arithmetic.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from sklearn.neural_network._base import ACTIVATIONS, DERIVATIVES
from sklearn.neural_network._stochastic_optimizers import AdamOptimizer

from softkin.core.samples import Array


class Batches:
    """The layers of a network, and one batch of rows on its way through them: outputs and deltas of each layer.

    `weights` and `biases` of each layer are views of the vector `packed`, their gradients of `gradient`.

    Parameters:
        coefs: weights of each layer (fan_in, fan_out).
        intercepts: its biases (fan_out,).
        activation: of the hidden layers, by scikit-learn's name.
        alpha: penalty on the squared weights.
        n_rows: rows of a batch at most.
    """

    def __init__(
        self, coefs: Sequence[Array], intercepts: Sequence[Array], *, activation: str, alpha: float, n_rows: int
    ) -> None:
        self.alpha, self.activate, self.times_slope = alpha, ACTIVATIONS[activation], DERIVATIVES[activation]
        self.packed = np.concatenate([np.ravel(part) for part in (*coefs, *intercepts)])
        self.gradient = np.empty_like(self.packed)
        self.shapes = [part.shape for part in (*coefs, *intercepts)]
        n_layers = len(coefs)
        (self.weights, self.biases), (self.weight_slopes, self.bias_slopes) = (
            (parts[:n_layers], parts[n_layers:]) for parts in (self._parts(self.packed), self._parts(self.gradient))
        )
        self.outputs = [np.empty((n_rows, len(biases))) for biases in intercepts]
        self.deltas = [np.empty_like(outputs) for outputs in self.outputs]

    def _parts(self, packed: Array) -> list[Array]:
        ends = np.cumsum([0, *(int(np.prod(shape)) for shape in self.shapes)]).tolist()
        return [
            packed[start:end].reshape(shape) for (start, end), shape in zip(pairwise(ends), self.shapes, strict=True)
        ]

    def loss(self, X: Array, y: Array) -> float:
        """The loss of a batch X (n_rows, n_commands), y (n_rows, n_targets); fills in the gradient."""
        n_rows, last = len(X), len(self.weights) - 1
        outputs, deltas = [part[:n_rows] for part in self.outputs], [part[:n_rows] for part in self.deltas]
        inputs = [X, *outputs[:-1]]
        for layer, weights in enumerate(self.weights):
            np.matmul(inputs[layer], weights, out=outputs[layer])
            outputs[layer] += self.biases[layer]
            if layer < last:
                self.activate(outputs[layer])
        np.subtract(outputs[-1], y, out=deltas[-1])
        squares = 0
        for weights in self.weights:
            flat = weights.ravel()
            squares += np.dot(flat, flat)
        squares_of_targets = np.add.reduce(np.square(deltas[-1]), axis=0) / n_rows
        loss = 0.5 * (np.add.reduce(squares_of_targets) / len(squares_of_targets))
        loss += (0.5 * self.alpha) * squares / n_rows
        for layer in range(last, -1, -1):
            np.matmul(inputs[layer].T, deltas[layer], out=self.weight_slopes[layer])
            self.weight_slopes[layer] += self.alpha * self.weights[layer]
            np.add.reduce(deltas[layer], axis=0, out=self.bias_slopes[layer])
            if layer:
                np.matmul(deltas[layer], self.weights[layer].T, out=deltas[layer - 1])
                self.times_slope(outputs[layer - 1], deltas[layer - 1])
        self.gradient /= n_rows
        return float(loss)


def quick_adam(
    batches: Batches,
    X: Array,
    y: Array,
    *,
    batch_size: int,
    optimizer: AdamOptimizer,
    random: np.random.RandomState,
) -> Iterator[float]:
    """The loss of each pass over the rows in turn, after which `batches` holds the parameters; endless.

    Parameters:
        batches: the network, of which `packed` is minimised in place.
        X: commands (n_rows, n_commands).
        y: targets (n_rows, n_targets).
        batch_size: rows of a batch.
        optimizer: of one vector, that of the parameters.
        random: shuffles the rows before each pass.
    """
    n_rows, order = len(X), np.arange(len(X))
    while True:
        drawn = np.arange(n_rows)
        random.shuffle(drawn)
        order = order[drawn]
        rows, targets, total = X[order], y[order], 0.0
        for start in range(0, n_rows, batch_size):
            part = rows[start : start + batch_size]
            total += batches.loss(part, targets[start : start + batch_size]) * len(part)
            optimizer.update_params([batches.packed], [batches.gradient])
        yield total / n_rows
