#include "onmesh/filter.h"
