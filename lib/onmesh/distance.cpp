#include "onmesh/distance.h"
