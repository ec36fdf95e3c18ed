// Purpose: how far what is seen in a block has gone lately, before a camera that stands. People who
//          move where they stand go less in a frame than flow is sure of, and their plain parts look
//          as what is remembered there; but after some frames they have gone some way.
// Inputs:  texels of the displacement: xy: px of the full image; what is older counts less, with
//          kDisplacementSeconds. z: how long ago, s, the block was last seen to move slowly; below 0
//          while it has done so for less than kSureSeconds; kNever, or kPassing. w: the share of its
//          cells that are other content than the background, where it has moved.
// Outputs: functions of them.
// Precision: highp; stored as half floats.
const float kDisplacementSeconds = 0.4;
const float kSureSeconds = 0.2;
const float kInPlaceSeconds = 5.0;  // so long after it moved, a block may be of a mover in place
const float kNever = 1000.0;
const float kPassing = 2000.0;   // something goes through the picture
const float kLeastOthers = 0.1;  // share of other content by which a block bounds a mover

bool mayBeInPlace(vec4 displacement) {
  return displacement.z >= 0.0 && displacement.z < kInPlaceSeconds;
}
bool boundsMover(vec4 displacement) { return displacement.w > kLeastOthers; }
