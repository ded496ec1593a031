#include "onmesh/length.h"
