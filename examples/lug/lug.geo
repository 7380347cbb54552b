// A lug of 40 mm width: two bolt holes in line, a slot as cut-out, a round end about its pin hole. Millimetres.
// Elements as large as the outline allows, since the p-version takes its accuracy from the degree (docs/meshes.md). Each hole has a layer out to a square, so
// that Gmsh's own elements between the layers have straight edges, and the subdivision halves all of them.
Mesh.Algorithm = 6;               // Frontal-Delaunay; 8 crashes in Gmsh 4.8.4 on a plate with a hole
Mesh.RecombineAll = 1;
Mesh.RecombinationAlgorithm = 1;  // Blossom
Mesh.SubdivisionAlgorithm = 1;    // quadrilaterals alone
Mesh.ElementOrder = 2;            // the nodes in the middle of edges tell which are arcs
DefineConstant[ size = 40 ];      // largest element between the layers
DefineConstant[ n = 1 ];          // elements along a quarter of a circle, before the subdivision

// A layer between the circle of radius r about (cx, cy) and the square from -h to h: its corners, sides and their loop.
Macro Layer
  m = newp; Point(m) = {cx, cy, 0};
  points[] = {}; corners[] = {}; sides[] = {}; rays[] = {}; rim[] = {};
  For i In {0:3}
    angle = (2 * i - 3) * Pi / 4;
    p = newp; Point(p) = {cx + r * Cos(angle), cy + r * Sin(angle), 0}; points[] += p;
    p = newp; Point(p) = {cx + h * Sqrt(2) * Cos(angle), cy + h * Sqrt(2) * Sin(angle), 0}; corners[] += p;
    k = newl; Line(k) = {points[i], corners[i]}; rays[] += k;
  EndFor
  For i In {0:3}
    j = (i + 1) % 4;
    k = newl; Circle(k) = {points[i], m, points[j]}; rim[] += k;
    k = newl; Line(k) = {corners[i], corners[j]}; sides[] += k;
  EndFor
  For i In {0:3}
    k = newll; Curve Loop(k) = {rays[i], sides[i], -rays[(i + 1) % 4], -rim[i]};
    s = news; Plane Surface(s) = {k}; Transfinite Surface {s}; layers[] += s;
  EndFor
  Transfinite Curve {rays[]} = 2;
  Transfinite Curve {rim[], sides[]} = n + 1;
  loop = newll; Curve Loop(loop) = sides[];
Return

layers[] = {};
cx = 15; cy = 0; r = 4; h = 7;
Call Layer;
bolt1 = loop;
cx = 40;
Call Layer;
bolt2 = loop;
cx = 100; r = 8; h = 11;
Call Layer;
pin = m; pin_sides[] = sides[]; pin_corners[] = corners[];

// The slot from x = 57 to 77, its ends of radius 5, and its layer out to a hexagon.
about[] = {62, 72, 72, 72, 62, 62}; at[] = {-Pi / 2, -Pi / 2, 0, Pi / 2, Pi / 2, Pi};
middles[] = {};
p = newp; Point(p) = {62, 0, 0}; middles[] += p;
p = newp; Point(p) = {72, 0, 0}; middles[] += p;
points[] = {}; corners[] = {}; sides[] = {}; rays[] = {}; rim[] = {};
For i In {0:5}
  p = newp; Point(p) = {about[i] + 5 * Cos(at[i]), 5 * Sin(at[i]), 0}; points[] += p;
  p = newp; Point(p) = {about[i] + 10 * Cos(at[i]), 10 * Sin(at[i]), 0}; corners[] += p;
  k = newl; Line(k) = {points[i], corners[i]}; rays[] += k;
EndFor
For i In {0:5}
  j = (i + 1) % 6;
  k = newl;
  If (i == 0 || i == 3)
    Line(k) = {points[i], points[j]};
  Else
    Circle(k) = {points[i], middles[i < 3], points[j]};
  EndIf
  rim[] += k;
  k = newl; Line(k) = {corners[i], corners[j]}; sides[] += k;
EndFor
For i In {0:5}
  k = newll; Curve Loop(k) = {rays[i], sides[i], -rays[(i + 1) % 6], -rim[i]};
  s = news; Plane Surface(s) = {k}; Transfinite Surface {s}; layers[] += s;
EndFor
Transfinite Curve {rays[]} = 2;
Transfinite Curve {rim[], sides[]} = n + 1;
slot = newll; Curve Loop(slot) = sides[];

// The outline: the tail, and the round end about the pin, whose middle half has a layer between it and the pin's square.
p1 = newp; Point(p1) = {0, -20, 0, size}; p2 = newp; Point(p2) = {100, -20, 0, size};
p3 = newp; Point(p3) = {100 + 10 * Sqrt(2), -10 * Sqrt(2), 0}; p4 = newp; Point(p4) = {100 + 10 * Sqrt(2), 10 * Sqrt(2), 0};
p5 = newp; Point(p5) = {100, 20, 0, size}; p6 = newp; Point(p6) = {0, 20, 0, size};
bottom = newl; Line(bottom) = {p1, p2};
arc1 = newl; Circle(arc1) = {p2, pin, p3}; arc2 = newl; Circle(arc2) = {p3, pin, p4}; arc3 = newl; Circle(arc3) = {p4, pin, p5};
top = newl; Line(top) = {p5, p6};
tail = newl; Line(tail) = {p6, p1};
below = newl; Line(below) = {pin_corners[1], p3}; above = newl; Line(above) = {pin_corners[2], p4};
k = newll; Curve Loop(k) = {below, arc2, -above, -pin_sides[1]};
s = news; Plane Surface(s) = {k}; Transfinite Surface {s}; layers[] += s;
Transfinite Curve {below, above} = 2;
Transfinite Curve {arc1, arc2, arc3} = n + 1;
outline = newll; Curve Loop(outline) = {bottom, arc1, -below, -pin_sides[0], -pin_sides[3], -pin_sides[2], above, arc3, top, tail};
rest = news; Plane Surface(rest) = {outline, bolt1, bolt2, slot};

Physical Surface("lug") = {layers[], rest};
Physical Curve("tail") = {tail};
