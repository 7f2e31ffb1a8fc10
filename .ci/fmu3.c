/* A unit of FMI 3.0 as a program in C takes it, by the standard's headers: fmu3 TOKEN RESOURCES STEP INPUT OUTPUT.
 * Prints the output at twenty points, and the last ten again after a state was saved as bytes and read. */
#include <stdbool.h>

#include "fmi3Functions.h"
#include "fmu.h"

static void logger(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category, fmi3String message) {
    told += environment == (void *)0x77 && status == fmi3Error && strcmp(category, "logStatusError") == 0 &&
            strstr(message, "valid:") != NULL;
}

static int follow(fmi3Instance unit, double step, fmi3ValueReference output, int from, int to) {
    for (int k = from; k < to; k++) {
        /* The second value and the second reference are not to be read or written. */
        const fmi3ValueReference references[2] = {output, output};
        double values[2] = {0.0, 7.0}, time = 0.0;
        bool event = true, terminate = true, early = true;
        CHECK(fmi3DoStep(unit, k * step, step, true, &event, &terminate, &early, &time), fmi3OK);
        CHECK(event || terminate || early, false);
        CHECK(fmi3GetFloat64(unit, references, 1, values, 1), fmi3OK);
        CHECK(values[1], 7.0);
        printf("%.17g\n", values[0]);
    }
    return 0;
}

int main(int argc, char **argv) {
    if (argc != 6) return 2;
    const double step = strtod(argv[3], NULL);
    const fmi3ValueReference input = (fmi3ValueReference)atoi(argv[4]), output = (fmi3ValueReference)atoi(argv[5]);
    CHECK(strcmp(fmi3GetVersion(), "3.0"), 0);
    fmi3Instance unit = fmi3InstantiateCoSimulation("one", argv[1], argv[2], false, false, false, false, NULL, 0,
                                                    (void *)0x77, logger, NULL);
    CHECK(unit != NULL, 1);
    CHECK(fmi3EnterInitializationMode(unit, false, 0.0, 0.0, true, 21 * step), fmi3OK);
    CHECK(fmi3ExitInitializationMode(unit), fmi3OK);
    double values[2] = {0.0, 0.0};
    CHECK(fmi3GetFloat64(unit, &input, 1, values, 1), fmi3OK);
    values[0] += 1e-4;
    CHECK(fmi3SetFloat64(unit, &input, 1, values, 1), fmi3OK);
    CHECK(fmi3SetFloat64(unit, &input, 1, values, 2), fmi3Error);
    CHECK(fmi3SetFloat64(unit, NULL, 1, values, 1), fmi3Error);
    CHECK(fmi3GetFloat64(unit, NULL, 0, NULL, 0), fmi3OK);
    CHECK(follow(unit, step, output, 0, 10), 0);
    fmi3FMUState state = NULL, read = NULL;
    size_t size = 0;
    CHECK(fmi3GetFMUState(unit, &state), fmi3OK);
    CHECK(fmi3SerializedFMUStateSize(unit, state, &size), fmi3OK);
    fmi3Byte *bytes = malloc(size);
    CHECK(fmi3SerializeFMUState(unit, state, bytes, size), fmi3OK);
    CHECK(fmi3SerializeFMUState(unit, state, bytes, size - 1), fmi3Error);
    CHECK(follow(unit, step, output, 10, 20), 0);
    CHECK(fmi3DeserializeFMUState(unit, bytes, size, &read), fmi3OK);
    free(bytes);
    CHECK(fmi3SetFMUState(unit, read), fmi3OK);
    CHECK(follow(unit, step, output, 10, 20), 0);
    CHECK(fmi3FreeFMUState(unit, &state), fmi3OK);
    CHECK(fmi3FreeFMUState(unit, &read), fmi3OK);
    CHECK(state == NULL && read == NULL, 1);
    CHECK(fmi3Terminate(unit), fmi3OK);
    fmi3FreeInstance(unit);
    /* Values of another number, no address, no room; each with what would be valid. */
    CHECK(told, 3);
    return 0;
}
