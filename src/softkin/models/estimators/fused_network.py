"""Multi-layer perceptron whose L-BFGS computes loss and gradient in one pass, over arrays that are made once."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from itertools import islice, pairwise
from typing import Any, NamedTuple

import numpy as np
from sklearn.exceptions import ConvergenceWarning
from sklearn.neural_network import MLPRegressor
from sklearn.neural_network._stochastic_optimizers import AdamOptimizer

from softkin.core.samples import Array
from softkin.models.estimators.quick_adam import Batches, quick_adam
from softkin.models.estimators.quick_lbfgs import quick_lbfgs


class Activation(NamedTuple):
    """`apply` takes `scale` times the inputs of neurons to their outputs, in place; `times_slope` multiplies a delta by
    the slope at these outputs, which it overwrites.
    """

    scale: float
    apply: Callable[[Array], Any]
    times_slope: Callable[[Array, Array], Any]


def _tanh(doubled: Array) -> None:
    """1 - 2 / (exp(2x) + 1): numpy.tanh took twice the time, and most of a fit (AVX2, numpy 2.4)."""
    np.exp(doubled, out=doubled)
    doubled += 1.0
    np.divide(-2.0, doubled, out=doubled)
    doubled += 1.0


def _times_tanh_slope(delta: Array, outputs: Array) -> None:
    np.square(outputs, out=outputs)
    np.subtract(1.0, outputs, out=outputs)
    delta *= outputs


def _logistic(negated: Array) -> None:
    np.exp(negated, out=negated)
    negated += 1.0
    np.reciprocal(negated, out=negated)


def _times_logistic_slope(delta: Array, outputs: Array) -> None:
    delta *= outputs
    np.subtract(1.0, outputs, out=outputs)
    delta *= outputs


def _relu(inputs: Array) -> None:
    np.maximum(inputs, 0.0, out=inputs)


def _times_relu_slope(delta: Array, outputs: Array) -> None:
    np.sign(outputs, out=outputs)
    delta *= outputs


#: scikit-learn's own size of a batch.
BATCH = 200

ACTIVATIONS = {
    "tanh": Activation(2.0, _tanh, _times_tanh_slope),
    "logistic": Activation(-1.0, _logistic, _times_logistic_slope),
    "relu": Activation(1.0, _relu, _times_relu_slope),
    "identity": Activation(1.0, lambda _: None, lambda *_: None),
}


class FusedLoss:
    """Loss of a network and the gradient that scikit-learn's L-BFGS searches along, at packed parameters.

    Both equal scikit-learn's to rounding. With several targets the loss is the mean over them and the gradient that of
    the sum: so it is in scikit-learn (its issue 8349).

    Arrays have a row per neuron and a column per row of X. The inputs of each layer end with a row of ones and so its
    weights with a column of biases: one product then gives all outputs of a layer, and one all its gradients.

    Parameters:
        X: commands (n_rows, n_commands).
        y: targets (n_rows, n_targets).
        row_weights: how much each row counts (n_rows,).
        widths: neurons of each hidden layer.
        activation: a key of `ACTIVATIONS`.
        alpha: penalty on the squared weights; biases are free.
    """

    def __init__(
        self, X: Array, y: Array, row_weights: Array, *, widths: Sequence[int], activation: str, alpha: float
    ) -> None:
        self.targets, self.shares = np.ascontiguousarray(y.T), row_weights / row_weights.sum()
        self.activation = ACTIVATIONS[activation]
        sizes = [X.shape[1], *widths, y.shape[1]]
        self.shapes = [(fan_out, fan_in + 1) for fan_in, fan_out in pairwise(sizes)]
        ends = np.cumsum([rows * columns for rows, columns in self.shapes]).tolist()
        self.places = [slice(start, end) for start, end in pairwise([0, *ends])]
        self.inputs = [np.ones((columns, len(X))) for _, columns in self.shapes]
        self.inputs[0][:-1] = X.T
        self.deltas = [np.empty((rows, len(X))) for rows, _ in self.shapes]
        self.residuals = np.empty_like(self.targets)
        self.penalties = np.full(ends[-1], alpha / row_weights.sum())
        for layer in self.layers(self.penalties):
            layer[:, -1] = 0.0
        self.gradient, self.penalty = np.empty(ends[-1]), np.empty(ends[-1])
        self.packed, self.slopes = self.penalties, self.layers(self.gradient)
        self.weights = self.layers(self.packed)

    def layers(self, packed: Array) -> list[Array]:
        """Views of the parameters of each layer: weights, and the biases as last column (fan_out, fan_in + 1)."""
        return [packed[place].reshape(shape) for place, shape in zip(self.places, self.shapes, strict=True)]

    def __call__(self, packed: Array) -> tuple[float, Array]:
        """Loss and gradient at `packed` (n_parameters,); the next call overwrites the gradient."""
        if packed is not self.packed:  # a search hands the same vector over in each of its calls
            self.packed, self.weights = packed, self.layers(packed)
        squared_error = self._forward(self.weights)
        self._backward(self.weights, self.slopes)
        np.multiply(self.penalties, packed, out=self.penalty)
        self.gradient += self.penalty
        return 0.5 * (squared_error + float(np.dot(self.penalty, packed))), self.gradient

    def _forward(self, layers: list[Array]) -> float:
        """The mean squared error; fills in the outputs of hidden neurons and the last delta."""
        scale, activate, _ = self.activation
        for layer, outputs in enumerate(self.inputs[1:]):
            np.matmul(scale * layers[layer], self.inputs[layer], out=outputs[:-1])
            activate(outputs[:-1])
        np.matmul(layers[-1], self.inputs[-1], out=self.residuals)
        self.residuals -= self.targets
        np.multiply(self.residuals, self.shares, out=self.deltas[-1])
        return float(np.vdot(self.deltas[-1], self.residuals)) / len(self.targets)

    def _backward(self, layers: list[Array], gradients: list[Array]) -> None:
        """Fills in the gradient of half the squared error, from the last layer to the first."""
        for layer in range(len(layers) - 1, -1, -1):
            np.matmul(self.deltas[layer], self.inputs[layer].T, out=gradients[layer])
            if layer:
                np.matmul(layers[layer][:, :-1].T, self.deltas[layer], out=self.deltas[layer - 1])
                self.activation.times_slope(self.deltas[layer - 1], self.inputs[layer][:-1])


class FusedNetwork(MLPRegressor):  # type: ignore[misc]
    """MLPRegressor whose solver lbfgs minimises the squared error by `FusedLoss`, and adam by `quick_adam`, to the bit
    where scikit-learn comes; all else is scikit-learn's.
    """

    coefs_: list[Array]
    intercepts_: list[Array]

    def _fit_lbfgs(self, X: Array, y: Array, sample_weight: Array | None, *others: Any) -> None:
        """Minimise the loss from the initial `coefs_` and `intercepts_`; scikit-learn's `fit` calls it by this name."""
        if self.loss != "squared_error":
            super()._fit_lbfgs(X, y, sample_weight, *others)
            return
        row_weights = np.ones(len(X)) if sample_weight is None else sample_weight
        widths = [len(biases) for biases in self.intercepts_[:-1]]
        loss = FusedLoss(X, y, row_weights, widths=widths, activation=self.activation, alpha=self.alpha)
        start = np.concatenate(
            [np.column_stack([w.T, b]).ravel() for w, b in zip(self.coefs_, self.intercepts_, strict=True)]
        )
        with np.errstate(over="ignore"):  # of exp, where a neuron is saturated
            optimum = quick_lbfgs(loss, start, max_iter=self.max_iter, tolerance=self.tol, max_calls=self.max_fun)
        if optimum.status:
            warnings.warn(f"L-BFGS stopped: {optimum.message}", ConvergenceWarning, stacklevel=2)
        self.n_iter_, self.loss_ = optimum.nit, optimum.fun
        layers = loss.layers(optimum.x)
        self.coefs_ = [np.ascontiguousarray(layer[:, :-1].T) for layer in layers]
        self.intercepts_ = [layer[:, -1].copy() for layer in layers]

    def _fit_stochastic(self, X: Array, y: Array, sample_weight: Array | None, *others: Any) -> None:
        """Minimise the loss from the initial `coefs_` and `intercepts_`; scikit-learn's `fit` calls it by this name."""
        plain = self.solver == "adam" and self.loss == "squared_error" and self.shuffle and self.batch_size == "auto"
        double = X.dtype == y.dtype == np.float64
        if sample_weight is not None or self.early_stopping or self.warm_start or others[-1] or not (plain and double):
            super()._fit_stochastic(X, y, sample_weight, *others)
            return
        size = min(BATCH, len(X))
        network = Batches(self.coefs_, self.intercepts_, activation=self.activation, alpha=self.alpha, n_rows=size)
        optimizer = AdamOptimizer([network.packed], self.learning_rate_init, self.beta_1, self.beta_2, self.epsilon)
        losses = quick_adam(network, X, y, batch_size=size, optimizer=optimizer, random=self._random_state)
        for loss in islice(losses, self.max_iter):
            self.loss_curve_.append(loss)
            self._update_no_improvement_count(False, None, None, None)
            if self._no_improvement_count > self.n_iter_no_change:
                break
        else:
            warnings.warn(f"Adam stopped after {self.max_iter} passes", ConvergenceWarning, stacklevel=2)
        self.n_iter_, self.loss_ = len(self.loss_curve_), self.loss_curve_[-1]
        self.t_ = self.n_iter_ * len(X)
        self.coefs_, self.intercepts_ = ([part.copy() for part in parts] for parts in (network.weights, network.biases))
