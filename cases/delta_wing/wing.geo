// A delta wing with 45 degrees of sweep and a double-wedge section 2 % thick, in a box of air. Lengths in root chords; x aft from
// the apex, y to starboard, z up; the half y >= 0. gmsh -3 wing.geo -o wing.su2
SetFactory("OpenCASCADE");
span = 1; DefineConstant[ ridge = 0.01 ];  // half the thickness in the middle; gmsh -setnumber ridge 0.001 makes a thinner one
Point(1) = {0, 0, 0};  Point(2) = {1, span, 0};  Point(3) = {1, 0, 0};
Point(4) = {0.5, 0, ridge};  Point(5) = {0.5, 0, -ridge};
Line(1) = {1, 2};  Line(2) = {2, 3};
Line(3) = {1, 4};  Line(4) = {4, 3};  Line(5) = {4, 2};
Line(6) = {1, 5};  Line(7) = {5, 3};  Line(8) = {5, 2};
Curve Loop(1) = {1, -5, -3};  Plane Surface(1) = {1};
Curve Loop(2) = {5, 2, -4};   Plane Surface(2) = {2};
Curve Loop(3) = {1, -8, -6};  Plane Surface(3) = {3};
Curve Loop(4) = {8, 2, -7};   Plane Surface(4) = {4};
Curve Loop(5) = {3, 4, -7, -6};  Plane Surface(5) = {5};
Surface Loop(1) = {1, 2, 3, 4, 5};  Volume(1) = {1};
Box(2) = {-0.3, 0, -1.2, 1.7, 1.8, 2.4};
BooleanDifference(3) = { Volume{2}; Delete; }{ Volume{1}; Delete; };
eps = 1e-4;
Physical Volume("air") = {3};
all() = Boundary{ Volume{3}; };
plane() = Surface In BoundingBox{-0.3-eps, -eps, -1.2-eps, 1.4+eps, eps, 1.2+eps};
wing() = Surface In BoundingBox{-eps, -eps, -ridge-eps, 1+eps, span+eps, ridge+eps};
Physical Surface("wing") = wing();
Physical Surface("symmetry") = plane();
far() = all(); far() -= wing(); far() -= plane();
Physical Surface("farfield") = far();
// Fine on the wing, coarse away from it.
Field[1] = Distance; Field[1].SurfacesList = {wing()};
Field[2] = Threshold; Field[2].InField = 1; Field[2].SizeMin = 0.03; Field[2].SizeMax = 0.2; Field[2].DistMin = 0.05; Field[2].DistMax = 1;
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0;
