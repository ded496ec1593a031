#include "onmesh/kernel.h"
