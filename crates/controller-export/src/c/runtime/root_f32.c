#define root sqrtf
