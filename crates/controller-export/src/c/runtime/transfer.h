/* Filter of the reference's acceleration. */
typedef struct {
    @real@ section[@ORDER@];
    @real@ last; /* @L@: the error that it expected last */
    int32_t started;
} @X@_filter;
