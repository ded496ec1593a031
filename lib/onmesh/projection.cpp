#include "onmesh/projection.h"
