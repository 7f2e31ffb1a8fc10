/* What is known at the start of a control cycle. */
typedef struct {
@INPUTS@} @X@_input;

/* What a guard lets through, and why it does not. */
enum @X@_status {
    @U@_OFF = 0,            /* switched off */
    @U@_ON = 1,             /* the correction, or as much of it as is faded in */
    @U@_NOT_FINITE = 2,     /* tripped: a correction was not a number */
    @U@_POSITION_LIMIT = 3, /* tripped: the offset of the position was at its limit for too long */
    @U@_EFFORT_LIMIT = 4,   /* tripped: the offset of the command was */
    @U@_SURPRISE_LIMIT = 5  /* tripped: the axis was not where it was expected for too long */
};

/* What is added in this cycle. */
typedef struct {
    @real@ position; /* @L@: to the position error, or to the reference of the position loop */
    @real@ effort;   /* @E@: to the command of the speed controller */
    int32_t status;  /* of enum @X@_status */
@OUTPUTS@} @X@_output;

/* What the guard keeps to: from @U@_LIMITS on, or set by @X@_limit. */
typedef struct {
    @real@ position;   /* @L@: greatest offset of the position */
    @real@ effort;     /* @E@: greatest offset of the command */
    @real@ surprise;   /* greatest deviation of the observer, in standard deviations */
    uint32_t patience; /* cycles for which a limit may be exceeded before it trips */
    uint32_t fade;     /* cycles of fading in and out, and of going over; 0: at once */
} @X@_limits;

/* Position (@L@), effort (@E@), surprise, patience, fade. */
#define @U@_LIMITS {@LIMITS@}

@STATES@/* The state, the caller's: once for each axis. */
typedef struct {
@MEMBERS@    uint32_t initialised; /* of @X@_init */
} @X@;
