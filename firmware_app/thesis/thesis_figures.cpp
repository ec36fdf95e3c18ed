#include "firmware_app/thesis/thesis_figures.h"

namespace pleinair::app {

const std::vector<ThesisFigureKind>& thesisFigures() {
  static const std::vector<ThesisFigureKind> kFigures{
      {.name = "15_16_21",
       .title = "Figures 15, 16 and 21: tensor field, pyramid, layers",
       .numbers = {15, 16, 21},
       .thesis = "Three levels of the pyramid that spreads the directions of strong edges to "
                 "regions without "
                 "any (15), the field of an AR frame as short lines (16), and the skeletons of the "
                 "coarse "
                 "layer's strokes (21). The pyramid is proposed in place of a global radial-basis "
                 "interpolation (eq. 11 and 12), which visits every edge pixel for every place.",
       .ours =
           "An AR frame with the gearbox: its field, four levels of its pyramid, which regions are "
           "painted how finely, the strokes' layers and skeletons. The last picture shows in red "
           "where "
           "our field differs from eq. 12: white at 0°, full red at 45° and more.",
       .make = fieldFigure},
      {.name = "17_18",
       .title = "Figures 17 and 18: features, matches, and warped anchors",
       .numbers = {17, 18},
       .thesis =
           "An anchor is carried by the triangle of its three nearest features, in barycentric "
           "coordinates (17). Harris corners with SIFT descriptors are matched between two AR "
           "frames "
           "(18: 80 matches of 256 and 206 features), and the anchors in four areas of the "
           "paintings "
           "go with them.",
       .ours = "Two frames of the hand-held camera, with the features of the thesis's method above "
               "and of "
               "this program's (Lucas-Kanade from key frames) below; then one anchor (red) and its "
               "triangle (blue) before and after. The picture is pale so that lines can be seen.",
       .make = featureFigure},
      {.name = "19_20",
       .title = "Figures 19 and 20: a stroke's quads, and brushes",
       .numbers = {19, 20},
       .thesis = "A curly stroke with eleven control points is divided into quads along its "
                 "spline, 4 (n + 2) "
                 "of them (19); brushes have an alpha mask and a texture (20).",
       .ours = "The same part of a painting with the thesis's quads and with as few quads as "
               "strokes bend, "
               "beside their skeletons; then painted with each of the six built-in brushes.",
       .make = strokeFigure},
      {.name = "22_24_25",
       .title = "Figures 22, 24 and 25: a still picture, and Hays and Essa's way",
       .numbers = {22, 24, 25},
       .thesis =
           "A finished painting with its fine details (22), paintings of photographs, said to be "
           "comparable with Hays and Essa's (24), and one of them from near (25).",
       .ours = "The workbench without noise, painted by this program and by a baseline of Hays and "
               "Essa's "
               "method. Their program, brush scans and pictures are not published, so that their "
               "results "
               "themselves cannot be shown or measured; the baseline is made from their paper: "
               "straight "
               "strokes of one segment along a global radial-basis field, clipped at edges, finer "
               "layers "
               "only where there is detail, here with plain round strokes. A judgement of taste, "
               "which of "
               "both looks better, would need viewers and is not made.",
       .make = photographFigure},
      {.name = "23_31",
       .title = "Figures 23 and 31: a stroke is blended with what it was",
       .numbers = {23, 31},
       .thesis = "Two diagrams: the mean of two parameterised strokes (23), and strokes of "
                 "different lengths, "
                 "which are all grown to full length for the mean, while only the valid part is "
                 "painted (31).",
       .ours =
           "The skeletons of the same strokes in two frames of a still scene that differ by sensor "
           "noise alone: a pixel is red where they differ. Above with hardly any memory, below "
           "with the "
           "thesis's.",
       .make = blendingFigure},
      {.name = "26",
       .title = "Figure 26: strokes that live",
       .numbers = {26},
       .thesis =
           "Painted AR frames without and with coherence: without, strokes in circles appear and "
           "disappear from frame to frame; with it, they stay.",
       .ours =
           "The swaying tube before the walking camera. Strokes of the first frame are circled in "
           "later ones; a cross stands where a stroke has gone. Above coherence 0.5, below "
           "coherence "
           "0: each frame is painted anew.",
       .make = livesFigure},
      {.name = "27_table_1",
       .title = "Table 1 and figures 14 and 27: the stages, and their times",
       .numbers = {14, 27},
       .thesis =
           "Flow charts of the method in image space (14) and in model space (27): tensor field, "
           "anchors, strokes, painting; and the times of four stages a frame, on a Core2Duo of 2 "
           "GHz "
           "with an ATI 5730 (table 1): 375 ms in all at 1024×768, 740 ms at 1440×1050.",
       .ours = "The same four stages of this program in the order of its chart "
               "(docs/architecture.md has "
               "the whole): tensor field; features; warping, which carries anchors by whatever "
               "source is "
               "surest and controls their density; painting.",
       .make = stagesFigure},
      {.name = "28",
       .title = "Figure 28: anchors against area-weighted samples of the surface",
       .numbers = {28},
       .thesis = "Points drawn on a model in proportion to the area of its triangles (eq. 20 to "
                 "25, red) are "
                 "spread unevenly over the screen; anchors that are kept by a grid of 8×8 px cells "
                 "on the "
                 "screen (blue) are spread evenly, and stay so as the model moves.",
       .ours =
           "The gearbox at the first and at the last frame of a film that approaches it. Red: "
           "area-weighted samples, as "
           "many as give the first frame's cells the same mean. Blue: our anchors, one layer with "
           "cells of 8×8 px.",
       .make = densityFigure},
      {.name = "29_32_34_35",
       .title = "Figures 29, 32, 34 and 35: a static model",
       .numbers = {29, 32, 34, 35},
       .thesis =
           "The brush anchors (29) and brush skeletons (32) of an alien spaceship at four moments "
           "of a "
           "film, and the paintings of that spaceship (34) and of a tower (35) before a real "
           "background. Few anchors are new in each frame, and skeletons stick to the surface.",
       .ours = "The built-in gearbox, at rest, while a hand-held camera walks around it: anchors, "
               "skeletons and paintings of model and background together.",
       .make = staticModelFigure},
      {.name = "30_33",
       .title = "Figures 30 and 33: a skinned model",
       .numbers = {30, 33},
       .thesis =
           "Anchors (30) and skeletons (33) of a running figure whose mesh is skinned: anchors "
           "stick to "
           "the deformed surface, since they are kept as a triangle with barycentric coordinates.",
       .ours = "The built-in tube, a skin over seven joints, which sways.",
       .make = skinnedModelFigure},
      {.name = "morphing",
       .title = "Beyond figures 30 and 33: a morphing model",
       .numbers = {},
       .thesis = "Morph targets do not occur in the thesis.",
       .ours = "The built-in ball, which two morph targets deform.",
       .make = morphingModelFigure},
      {.name = "36_37",
       .title = "Figures 36 and 37: image space against model space, static model",
       .numbers = {36, 37},
       .thesis = "A dragon painted by the image-space and by the model-space algorithm, whole and "
                 "with its "
                 "wing from near: single frames look alike, but in model space strokes are much "
                 "more stable "
                 "from frame to frame.",
       .ours = "The gearbox at rest, while the camera walks around it.",
       .make = staticSpacesFigure},
      {.name = "38_39",
       .title = "Figures 38 and 39: image space against model space, animated model",
       .numbers = {38, 39},
       .thesis = "The same for the running figure, and its chest from near: in model space the "
                 "strokes on "
                 "the chest stay as they are.",
       .ours = "The swaying tube.",
       .make = animatedSpacesFigure},
      {.name = "40",
       .title = "Figure 40: weight of the brush history, 0.05 against 0.95",
       .numbers = {40},
       .thesis =
           "The spaceship with a weight of 0.05 and of 0.95 on the previous strokes' colours and "
           "skeletons. With the small weight the painting flickers, although the anchors are "
           "right, "
           "because skeletons change between frames.",
       .ours = "The gearbox with the parameter memory at 0.0111 s and at 0.65 s: these are the "
               "thesis's "
               "weights at 30 frames a second, as time constants, τ = −(1/30)/ln α.",
       .make = memoryFigure},
      {.name = "41",
       .title = "Figure 41: without and with edge clipping",
       .numbers = {41},
       .thesis = "The running figure without and with strokes that are clipped at the border of "
                 "virtual and "
                 "real. Without, colours bleed over the border, and strokes that cross it are "
                 "carried along "
                 "by the model.",
       .ours = "The swaying tube with clip = false and with clip = true.",
       .make = clipFigure},
      {.name = "42",
       .title = "Figure 42: without and with bump mapping",
       .numbers = {42},
       .thesis = "The spaceship painted with the brushes' texture only, and with bump mapping, "
                 "which gives "
                 "the light of real paint.",
       .ours = "The gearbox with bump = \"off\" and with bump = \"once\".",
       .make = bumpFigure},
      {.name = "6_1",
       .title = "§6.1: six divisions of the work, and the pyramid of 2×2 means",
       .numbers = {},
       .thesis = "Future work: tensors on the GPU, in six ways: a thread for each row, column or "
                 "pixel, which "
                 "reads from global memory or from a texture; and a pyramid each level of which is "
                 "the mean "
                 "of 2×2 tensors of the level below. The best way is left open.",
       .ours =
           "All six as compute shaders, for the initial tensors and for the first level of such a "
           "pyramid. The painter does neither: its gradients are a fragment pass, a pixel each "
           "from a "
           "texture, because its next pass reads them as a texture and tilers like that best "
           "(docs/gpu.md); its pyramid interpolates within 5×5 regions and filters before it "
           "halves.",
       .make = divisionsFigure},
  };
  return kFigures;
}

}  // namespace pleinair::app
