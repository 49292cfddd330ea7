/* What headers written by softkin share: C99 and its mathematics alone. */
#ifndef SOFTKIN_RUNTIME_H
#define SOFTKIN_RUNTIME_H

#include <math.h>
#include <stddef.h>

/* Products of features; places[term * degree + factor], n_features stands for 1. */
static inline void softkin_polynomial(const double *x, int n_features, const int *places, int n_terms, int degree,
                                      const double *mean, const double *scale, const double *weights, int n_targets,
                                      double *y) {
    for (int term = 0; term < n_terms; term++) {
        double value = 1.0;
        for (int factor = 0; factor < degree; factor++) {
            int place = places[term * degree + factor];
            if (place < n_features) value *= x[place];
        }
        value = (value - mean[term]) / scale[term];
        for (int target = 0; target < n_targets; target++) y[target] += value * weights[term * n_targets + target];
    }
}

static inline double softkin_square(const double *a, const double *b, int n) {
    double sum = 0.0;
    for (int i = 0; i < n; i++) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

static inline double softkin_dot(const double *a, const double *b, int n) {
    double sum = 0.0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

static inline void softkin_exponential(const double *z, const double *points, int n, int d, double constant,
                                       double rate, double *k) {
    for (int i = 0; i < n; i++) k[i] += constant * exp(-rate * softkin_square(points + (size_t)i * (size_t)d, z, d));
}

static inline void softkin_matern32(const double *z, const double *points, int n, int d, double constant, double *k) {
    for (int i = 0; i < n; i++) {
        double far = sqrt(softkin_square(points + (size_t)i * (size_t)d, z, d)) * sqrt(3.0);
        k[i] += constant * ((1.0 + far) * exp(-far));
    }
}

static inline void softkin_matern52(const double *z, const double *points, int n, int d, double constant, double *k) {
    for (int i = 0; i < n; i++) {
        double far = sqrt(softkin_square(points + (size_t)i * (size_t)d, z, d)) * sqrt(5.0);
        k[i] += constant * ((1.0 + far + far * far / 3.0) * exp(-far));
    }
}

static inline void softkin_rational(const double *z, const double *points, int n, int d, double constant, double rate,
                                    double power, double *k) {
    for (int i = 0; i < n; i++)
        k[i] += constant * pow(1.0 + softkin_square(points + (size_t)i * (size_t)d, z, d) / rate, -power);
}

static inline void softkin_product(const double *z, const double *points, int n, int d, double constant, double rate,
                                   double offset, int power, double *k) {
    for (int i = 0; i < n; i++) {
        double base = rate * softkin_dot(points + (size_t)i * (size_t)d, z, d) + offset, value = 1.0;
        for (int factor = 0; factor < power; factor++) value *= base;
        k[i] += constant * value;
    }
}

/* Whether x, in units of lengths, is no farther than reach. */
static inline int softkin_within(const double *x, const double *lengths, int n, double reach) {
    double sum = 0.0;
    for (int i = 0; i < n; i++) sum += x[i] / lengths[i] * (x[i] / lengths[i]);
    return sum <= reach * reach;
}

/* Products of powers of z, x in units of lengths, weighed, times exp(-rate |z|^2); table has n * (degree + 1) places. */
static inline void softkin_powers(const double *x, const double *lengths, int n, double rate, const int *powers,
                                  int n_terms, int degree, const double *weights, int n_targets, double *table,
                                  double *y) {
    double squares = 0.0, envelope;
    for (int i = 0; i < n; i++) {
        double z = x[i] / lengths[i], *of_one = table + i * (degree + 1);
        of_one[0] = 1.0;
        for (int k = 0; k < degree; k++) of_one[k + 1] = of_one[k] * z;
        squares += z * z;
    }
    envelope = exp(-rate * squares);
    for (int term = 0; term < n_terms; term++) {
        double value = envelope;
        for (int i = 0; i < n; i++) value *= table[i * (degree + 1) + powers[term * n + i]];
        for (int target = 0; target < n_targets; target++) y[target] += value * weights[term * n_targets + target];
    }
}

static inline void softkin_weigh(const double *k, const double *weights, int n, int n_targets, double *y) {
    for (int i = 0; i < n; i++)
        for (int target = 0; target < n_targets; target++)
            y[target] += k[i] * weights[(size_t)i * (size_t)n_targets + (size_t)target];
}

/* The sum of squares of the solution of L v = k, in place; L (n, n) row by row without what is above its diagonal. */
static inline double softkin_explained(double *k, const double *lower, int n) {
    double sum = 0.0;
    const double *row = lower;
    for (int i = 0; i < n; i++) {
        k[i] = (k[i] - softkin_dot(row, k, i)) / row[i];
        sum += k[i] * k[i];
        row += i + 1;
    }
    return sum;
}

/* Activation: 0 identity, 1 tanh, 2 logistic, 3 rectifier. */
static inline void softkin_layer(const double *x, int n_in, const double *weights, const double *biases, int n_out,
                                 int activation, double *y) {
    for (int j = 0; j < n_out; j++) {
        double sum = biases[j];
        for (int i = 0; i < n_in; i++) sum += x[i] * weights[i * n_out + j];
        if (activation == 1) sum = tanh(sum);
        if (activation == 2) sum = 0.5 * (1.0 + tanh(0.5 * sum));
        if (activation == 3) sum = sum > 0.0 ? sum : 0.0;
        y[j] = sum;
    }
}

/* The leaf that a tree leads to. */
static inline int softkin_leaf(const double *x, int node, const int *feature, const double *threshold, const int *left,
                               const int *right, const int *leaf) {
    while (left[node] != node) node = x[feature[node]] <= threshold[node] ? left[node] : right[node];
    return leaf[node];
}

static inline double softkin_sinc(double angle) { return angle == 0.0 ? 1.0 : sin(angle) / angle; }

/* Bending towards x and y (rad) and length (mm) of an arc to the point at its end. */
static inline void softkin_arc_end(const double *arc, double *point) {
    double bending = hypot(arc[0], arc[1]), half = softkin_sinc(bending / 2.0);
    double sideways = arc[2] / 2.0 * (half * half);
    point[0] = sideways * arc[0];
    point[1] = sideways * arc[1];
    point[2] = arc[2] * softkin_sinc(bending);
}

/* The derivative of sin(angle) / angle, divided by the angle. */
static inline double softkin_sinc_slope(double angle) {
    double square = angle * angle;
    if (square < 0.3 * 0.3)
        return -1.0 / 3.0 +
               square * (1.0 / 30.0 - square * (1.0 / 840.0 - square * (1.0 / 45360.0 - square / 3991680.0)));
    return (cos(angle) - softkin_sinc(angle)) / square;
}

/* Standard deviation of the point in the data's frame, to first order; axes (3, 3). */
static inline void softkin_arc_spread(const double *arc, const double *spread, const double *axes, double *result) {
    double x = arc[0], y = arc[1], length = arc[2], bending = hypot(x, y), half = softkin_sinc(bending / 2.0);
    double sideways = length / 2.0 * (half * half), lower = length * softkin_sinc_slope(bending);
    double narrower = length / 4.0 * half * softkin_sinc_slope(bending / 2.0);
    double slopes[3][3];
    slopes[0][0] = sideways + narrower * x * x;
    slopes[0][1] = slopes[1][0] = narrower * x * y;
    slopes[1][1] = sideways + narrower * y * y;
    slopes[0][2] = lower * x;
    slopes[1][2] = lower * y;
    slopes[2][0] = half * half / 2.0 * x;
    slopes[2][1] = half * half / 2.0 * y;
    slopes[2][2] = softkin_sinc(bending);
    for (int row = 0; row < 3; row++) {
        double squares = 0.0;
        for (int axis = 0; axis < 3; axis++) {
            double moved = softkin_dot(slopes[axis], axes + row * 3, 3) * spread[axis];
            squares += moved * moved;
        }
        result[row] = sqrt(squares);
    }
}

/* Whether all points are farther from z than gap. */
static inline int softkin_far(const double *z, const double *points, int n, int d, double gap) {
    double enough = gap * gap * (1.0 + 1e-9);
    for (int i = 0; i < n; i++) {
        double square = softkin_square(points + (size_t)i * (size_t)d, z, d);
        if (square <= enough && sqrt(square) <= gap) return 0;
    }
    return 1;
}

/* Squared distances to the k nearest points, ascending, into best. */
static inline void softkin_nearest(const double *z, const double *points, int n, int d, int k, double *best) {
    int held = 0;
    for (int i = 0; i < n; i++) {
        double square = softkin_square(points + (size_t)i * (size_t)d, z, d);
        int place;
        if (held == k && square >= best[k - 1]) continue;
        place = held < k ? held++ : k - 1;
        for (; place > 0 && best[place - 1] > square; place--) best[place] = best[place - 1];
        best[place] = square;
    }
}

/* Mean distance to the k nearest points; best has room for k numbers. */
static inline double softkin_neighbours(const double *z, const double *points, int n, int d, int k, double *best) {
    double sum = 0.0;
    softkin_nearest(z, points, n, d, k, best);
    for (int i = 0; i < k; i++) sum += sqrt(best[i]);
    return sum / k;
}

/* Mean of the errors at the k nearest points and those that are as near; best has room for k numbers. */
static inline double softkin_near(const double *z, const double *points, const double *errors, int n, int d, int k,
                                  double *best) {
    double sum = 0.0, limit;
    int count = 0;
    softkin_nearest(z, points, n, d, k, best);
    limit = best[k - 1] * (1.0 + 1e-9) + 1e-18;
    for (int i = 0; i < n; i++)
        if (softkin_square(points + (size_t)i * (size_t)d, z, d) <= limit) {
            sum += errors[i];
            count++;
        }
    return sum / count;
}

static inline int softkin_usable(const double *command, int n) {
    for (int i = 0; i < n; i++)
        if (!(fabs(command[i]) <= 1e100)) return 0;
    return 1;
}

#endif
