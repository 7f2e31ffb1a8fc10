#define root sqrt
