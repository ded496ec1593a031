#include "onmesh/refine.h"
