// SPDX-License-Identifier: Apache-2.0
// Never run: declares every shared struct that lies in buffers as storage, those too that kernels read as texels.
#include "shared/prelude.glsl"
#include "shared/photons.h"
#include "shared/scene.h"
#include "shared/trace.h"
#pragma binding readonly Triangle triangles
#pragma binding readonly TriangleNormals normals
#pragma binding readonly Material materials
#pragma binding readonly Light lights
#pragma binding readonly EmittingTriangle emitting
#pragma binding readonly BvhNode nodes
#pragma binding readonly Texture textures
#pragma binding readonly MaterialPaint paints
#pragma binding readonly CornerCoordinates coordinates
#pragma binding readonly CornerColors colors
#pragma binding readonly SceneHeader headers
#pragma binding readonly EnvironmentHeader environments
#pragma binding readonly TreeNode tree_nodes
#pragma binding readonly LightEmission emitters
#pragma binding readonly PathSummary summaries
#pragma binding readonly BalanceSum balance

void main() {}
