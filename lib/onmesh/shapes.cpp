#include "onmesh/shapes.h"
