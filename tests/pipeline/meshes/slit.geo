// Half a period of collinear cracks of half length 0.5 at pitch 2, of import_mesh_test.py.
lc = 0.5;
Point(1) = {0,-5,0,1}; Point(2) = {1,-5,0,1}; Point(3) = {1,0,0,lc}; Point(4) = {1,5,0,1}; Point(5) = {0,5,0,1}; Point(6) = {0,0,0,lc}; Point(7) = {0.5,0,0,lc};
Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,5}; Line(5) = {5,6}; Line(6) = {6,1}; Line(7) = {6,7}; Line(8) = {7,3};
Curve Loop(1) = {1,2,-8,-7,6}; Plane Surface(1) = {1};
Curve Loop(2) = {7,8,3,4,5}; Plane Surface(2) = {2};
Physical Surface("sheet") = {1,2};
Physical Curve("left") = {5,6}; Physical Curve("right") = {2,3}; Physical Curve("bottom") = {1}; Physical Curve("top") = {4}; Physical Curve("slit") = {7};
Mesh.Algorithm = 6; Mesh.RecombineAll = 1; Mesh.RecombinationAlgorithm = 1; Mesh.SubdivisionAlgorithm = 1;
