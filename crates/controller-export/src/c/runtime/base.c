#if defined(__FAST_MATH__)
#error "Compile without -ffast-math: what is not a number must stay that, for the guard to see it."
#endif
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#endif

typedef union {
    real value;
    bits pattern;
} number;
