/* Scalar product with eight partial sums, added pairwise. */
static real dot(const real *a, const real *b, unsigned length)
{
    real sum[8] = {R(0.0)};
    real tail = R(0.0);
    unsigned i = 0, c;

    for (; i + 8 <= length; i += 8) {
        for (c = 0; c < 8; c++) {
            sum[c] += a[i + c] * b[i + c];
        }
    }
    for (; i < length; i++) {
        tail += a[i] * b[i];
    }
    return ((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7])) + tail;
}

/* The sums of a layer's neurons. Weights lie in strips of 16 neurons until 20 or fewer are left,
 * filled up to a multiple of 4; in a strip input after input. Eight neurons and fewer have a sum
 * for each half of the inputs. Returns where the next layer's weights begin. */
static const real *layer(const real *weights, const real *input, unsigned seen, real *out, unsigned neurons)
{
    if (neurons == 1) {
        out[0] = dot(weights, input, seen);
        return weights + seen;
    }
    while (neurons > 0) {
        const unsigned width = (neurons > 20) ? 16 : (neurons + 3) / 4 * 4;
        const unsigned own = (width < neurons) ? width : neurons;
        const unsigned half = (width <= 8) ? seen / 2 : 0;
        real upper[20] = {R(0.0)}, lower[20] = {R(0.0)};
        unsigned i, c;

        for (i = 0; i < half; i++, weights += width) {
            for (c = 0; c < width; c++) {
                upper[c] += weights[c] * input[i];
            }
        }
        for (; i < seen; i++, weights += width) {
            for (c = 0; c < width; c++) {
                lower[c] += weights[c] * input[i];
            }
        }
        for (c = 0; c < own; c++) {
            out[c] = upper[c] + lower[c];
        }
        out += own;
        neurons -= own;
    }
    return weights;
}

/* The increment of the position over a cycle, @L@. */
static real network_increment(const real input[4])
{
    real activation[ACTIVATIONS];
    const real *weights = WEIGHTS;
    unsigned seen = 5, i, n;

    activation[0] = R(1.0);
    for (i = 0; i < 4; i++) {
        activation[1 + i] = (input[i] - INPUT_MINIMUM[i]) * INPUT_GAIN[i] - R(1.0);
    }
    for (i = 0; i + 1 < LAYERS; i++) {
        weights = layer(weights, activation, seen, activation + seen, NEURONS[i]);
        for (n = 0; n < NEURONS[i]; n++) {
            activation[seen + n] = tansig(activation[seen + n]);
        }
        seen += NEURONS[i];
    }
    return (dot(weights, activation, seen) + R(1.0)) * OUTPUT_HALF_WIDTH + OUTPUT_MINIMUM;
}
