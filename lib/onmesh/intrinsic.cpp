#include "onmesh/types.h"
