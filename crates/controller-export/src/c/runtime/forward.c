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

/* Adds to four sums the products of some inputs with weights of four neurons that lie side by
 * side, `width` from input to input. */
static void add_four(real sums[4], const real *weights, unsigned width, const real *input, unsigned inputs)
{
    real a = sums[0], b = sums[1], c = sums[2], d = sums[3];
    unsigned i;

    for (i = 0; i < inputs; i++, weights += width) {
        const real x = input[i];
        a += weights[0] * x;
        b += weights[1] * x;
        c += weights[2] * x;
        d += weights[3] * x;
    }
    sums[0] = a;
    sums[1] = b;
    sums[2] = c;
    sums[3] = d;
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
        unsigned at, c;

        for (at = 0; at < own; at += 4) {
            real upper[4] = {R(0.0)}, lower[4] = {R(0.0)};
            add_four(upper, weights + at, width, input, half);
            add_four(lower, weights + at + half * width, width, input + half, seen - half);
            for (c = 0; c < 4 && at + c < own; c++) {
                out[at + c] = upper[c] + lower[c];
            }
        }
        out += own;
        neurons -= own;
        weights += width * seen;
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
