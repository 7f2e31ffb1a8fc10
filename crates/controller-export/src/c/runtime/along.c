/* What depends on the position: linear between sections, constant beyond. */
static section section_at(real position)
{
    const real along = least(greatest((position - ALONG_LEAST) * ALONG_PER_LENGTH, R(0.0)), (real)(SECTIONS - 1));
    const unsigned node = (along < (real)(SECTIONS - 2)) ? (unsigned)along : SECTIONS - 2;
    const real share = along - (real)node;
    const section *a = &ALONG[node], *b = &ALONG[node + 1];
    section s;

    s.compliance = a->compliance + share * (b->compliance - a->compliance);
    s.rotating = a->rotating + share * (b->rotating - a->rotating);
    s.lagging = a->lagging + share * (b->lagging - a->lagging);
    s.load = a->load + share * (b->load - a->load);
    return s;
}
