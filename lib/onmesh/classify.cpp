#include "onmesh/classify.h"
