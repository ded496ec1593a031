#include "onmesh/texel_map.h"
