/* A unit of FMI 2.0 as a program in C takes it, by the standard's headers: fmu2 GUID RESOURCES STEP INPUT OUTPUT.
 * Prints the output at twenty points, and again after a state was saved as bytes and read. */
#include <stdarg.h>

#include "fmi2Functions.h"
#include "fmu.h"

static void logger(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                   fmi2String message, ...) {
    char text[2000];
    va_list arguments;
    va_start(arguments, message);
    vsnprintf(text, sizeof text, message, arguments);
    va_end(arguments);
    told += environment == (void *)0x77 && status == fmi2Error && strcmp(name, "100 %s") == 0 &&
            strcmp(category, "logStatusError") == 0 && strstr(text, "valid:") != NULL;
}

static int follow(fmi2Component unit, double step, fmi2ValueReference output, int from, int to) {
    for (int k = from; k < to; k++) {
        double value = 0.0;
        CHECK(fmi2DoStep(unit, k * step, step, fmi2True), fmi2OK);
        CHECK(fmi2GetReal(unit, &output, 1, &value), fmi2OK);
        printf("%.17g\n", value);
    }
    return 0;
}

int main(int argc, char **argv) {
    if (argc != 6) return 2;
    const fmi2CallbackFunctions functions = {logger, NULL, NULL, NULL, (void *)0x77};
    const double step = strtod(argv[3], NULL);
    const fmi2ValueReference input = (fmi2ValueReference)atoi(argv[4]), output = (fmi2ValueReference)atoi(argv[5]);
    CHECK(strcmp(fmi2GetTypesPlatform(), fmi2TypesPlatform), 0);
    CHECK(strcmp(fmi2GetVersion(), "2.0"), 0);
    fmi2Component unit = fmi2Instantiate("100 %s", fmi2CoSimulation, argv[1], argv[2], &functions, fmi2False, fmi2False);
    CHECK(unit != NULL, 1);
    CHECK(fmi2SetupExperiment(unit, fmi2False, 0.0, 0.0, fmi2True, 21 * step), fmi2OK);
    CHECK(fmi2EnterInitializationMode(unit), fmi2OK);
    CHECK(fmi2ExitInitializationMode(unit), fmi2OK);
    double value = 0.0;
    CHECK(fmi2GetReal(unit, &input, 1, &value), fmi2OK);
    value += 1e-4;
    CHECK(fmi2SetReal(unit, &input, 1, &value), fmi2OK);
    CHECK(follow(unit, step, output, 0, 10), 0);
    fmi2FMUstate state = NULL, read = NULL;
    size_t size = 0;
    CHECK(fmi2GetFMUstate(unit, &state), fmi2OK);
    CHECK(fmi2SerializedFMUstateSize(unit, state, &size), fmi2OK);
    char *bytes = malloc(size);
    CHECK(fmi2SerializeFMUstate(unit, state, bytes, size), fmi2OK);
    CHECK(fmi2SerializeFMUstate(unit, state, bytes, size - 1), fmi2Error);
    CHECK(follow(unit, step, output, 10, 20), 0);
    CHECK(fmi2DeSerializeFMUstate(unit, bytes, size, &read), fmi2OK);
    free(bytes);
    CHECK(fmi2SetFMUstate(unit, read), fmi2OK);
    CHECK(follow(unit, step, output, 10, 20), 0);
    CHECK(fmi2DoStep(unit, 20 * step, 2 * step, fmi2True), fmi2Error);
    fmi2Boolean terminated = fmi2True;
    fmi2Real time = 0.0;
    CHECK(fmi2GetBooleanStatus(unit, fmi2Terminated, &terminated), fmi2OK);
    CHECK(fmi2GetRealStatus(unit, fmi2LastSuccessfulTime, &time), fmi2OK);
    CHECK(terminated, fmi2False);
    CHECK(time > 19.99 * step && time < 20.01 * step, 1);
    CHECK(fmi2FreeFMUstate(unit, &state), fmi2OK);
    CHECK(fmi2FreeFMUstate(unit, &read), fmi2OK);
    CHECK(state == NULL && read == NULL, 1);
    CHECK(fmi2Terminate(unit), fmi2OK);
    fmi2FreeInstance(unit);
    CHECK(told, 2);
    return 0;
}
