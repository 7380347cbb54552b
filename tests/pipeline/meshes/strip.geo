// The strip of import_mesh_test.py: 60 by 20 with two holes of radius 3, linear elements.
Mesh.Algorithm = 6;
Mesh.RecombineAll = 1;
Mesh.RecombinationAlgorithm = 1;
Mesh.SubdivisionAlgorithm = 1;
size = 24;
Point(1) = {0, 0, 0, size}; Point(2) = {60, 0, 0, size}; Point(3) = {60, 20, 0, size}; Point(4) = {0, 20, 0, size};
For i In {1:4}
  Line(i) = {i, i % 4 + 1};
EndFor
Curve Loop(1) = {1:4};
For hole In {0:1}
  p = 10 * (hole + 1);
  x = 20 + 20 * hole;
  Point(p) = {x, 10, 0, size};
  Point(p + 1) = {x + 3, 10, 0, size}; Point(p + 2) = {x, 13, 0, size}; Point(p + 3) = {x - 3, 10, 0, size}; Point(p + 4) = {x, 7, 0, size};
  For i In {1:4}
    Circle(p + i) = {p + i, p, p + i % 4 + 1};
  EndFor
  Curve Loop(p) = {p + 1 : p + 4};
  Transfinite Curve {p + 1 : p + 4} = 2;
EndFor
Plane Surface(1) = {1, 10, 20};
Physical Surface("skin") = {1};
Physical Curve("left") = {4}; Physical Curve("right") = {2};
