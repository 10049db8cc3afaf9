// For measuring: how often a fragment runs its loops; nothing without COUNT_TRIPS.

#ifdef COUNT_TRIPS
// Of the short way, the long way and the fill.
ivec3 trips = ivec3(0);
#define COUNT_TRIP(loop) ++trips[loop];
#else
#define COUNT_TRIP(loop)
#endif
