// SPDX-License-Identifier: Apache-2.0
// Triangles of a Wavefront OBJ file: positions and faces, groups joined, polygons fanned.
#pragma once

#include <string>

#include "base/mesh.h"
#include "base/result.h"

namespace lorgnette {

// Errors name the file and the line. Normals and texture coordinates are not read.
Result<TriangleMesh> ReadObjTriangles(const std::string& path);

}  // namespace lorgnette
