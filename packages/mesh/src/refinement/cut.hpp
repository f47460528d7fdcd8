#pragma once
#include "thixis/mesh/mesh.hpp"

/// The ways to cut a triangle, in its six points: 0..2 its vertices, 3 + i the midpoint of its face i.
namespace thixis::mesh {

struct Cut {
  int children;
  int child[4][3];      ///< points of child c
  int face[4][3];       ///< face i of child c: the interior face k as k, the part of face k of the parent at its vertex v as 3 + 3 k + v
  int interior[3][2];   ///< end points of the interior face k; there are children - 1
  ChildShape shape[4];  ///< of child c, for the refinement edge 0
};
constexpr int part(int k, int v) { return 3 + 3 * k + v; }

constexpr Cut red = {4,
                     {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}, {3, 4, 5}},
                     {{0, part(1, 0), part(2, 0)}, {part(0, 1), 1, part(2, 1)}, {part(0, 2), part(1, 2), 2}, {0, 1, 2}},
                     {{4, 5}, {5, 3}, {3, 4}},
                     {1, 2, 3, 4}};

/// Newest-vertex bisection with the refinement edge 0: by the midpoint of this face alone, and those of face 2 (P), 1 (Q), both.
constexpr Cut bisections[4] = {{2, {{3, 0, 1}, {3, 2, 0}}, {{part(2, 0), part(0, 1), 0}, {part(1, 0), 0, part(0, 2)}}, {{3, 0}}, {5, 6}},
                               {3,
                                {{5, 3, 0}, {5, 1, 3}, {3, 2, 0}},
                                {{0, part(2, 0), 1}, {part(0, 1), 1, part(2, 1)}, {part(1, 0), 0, part(0, 2)}},
                                {{3, 0}, {3, 5}},
                                {7, 8, 6}},
                               {3,
                                {{3, 0, 1}, {4, 3, 2}, {4, 0, 3}},
                                {{part(2, 0), part(0, 1), 0}, {part(0, 2), part(1, 2), 1}, {0, 1, part(1, 0)}},
                                {{3, 0}, {3, 4}},
                                {5, 9, 10}},
                               {4,
                                {{5, 3, 0}, {5, 1, 3}, {4, 3, 2}, {4, 0, 3}},
                                {{0, part(2, 0), 2}, {part(0, 1), 2, part(2, 1)}, {part(0, 2), part(1, 2), 1}, {0, 1, part(1, 0)}},
                                {{3, 0}, {3, 4}, {3, 5}},
                                {7, 8, 9, 10}}};

/// A child of these bisections has the shape `shape[c] + shapes_per_edge e` where the refinement edge is e.
constexpr int shapes_per_edge = 6;

}  // namespace thixis::mesh
