#include "onmesh/poisson.h"
