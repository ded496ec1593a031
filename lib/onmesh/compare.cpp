#include "onmesh/compare.h"
