// error: DeviceType<
#include <cellist/cellist.hpp>

struct Hit {
    cl_float depth;
    const cl_uint* id;
};
CELLIST_STRUCT(Hit, depth, id);
