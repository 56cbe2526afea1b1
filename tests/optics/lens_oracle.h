// SPDX-License-Identifier: Apache-2.0
// The oracle of the kernels' bounds.
#pragma once

#include "optics/long_double_trace.h"
