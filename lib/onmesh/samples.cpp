#include "onmesh/samples.h"
