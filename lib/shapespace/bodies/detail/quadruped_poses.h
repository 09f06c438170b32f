#ifndef SHAPESPACE_BODIES_DETAIL_QUADRUPED_POSES_H_
#define SHAPESPACE_BODIES_DETAIL_QUADRUPED_POSES_H_

namespace shapespace::internal {

/// A joint's rotation in degrees: `pitch` about +y (a leg backwards, a head down), `yaw` about +z
/// (to the left), `roll` about +x (the left side up).
struct Turn {
  const char* bone;
  double pitch, yaw = 0, roll = 0;
};

constexpr Turn kStride[] = {{"neck", 6},
                            {"nape", 6, 6},
                            {"head", -8, 8},
                            {"loin", 0, 4},
                            {"chest", 0, 4},
                            {"tail root", 26, 10},
                            {"tail", 10, 10},
                            {"tail tip", 16, 10},
                            {"front left upper", -34},
                            {"front left lower", 0},
                            {"front left cannon", 10},
                            {"front right upper", 16},
                            {"front right lower", 10},
                            {"front right cannon", 18},
                            {"front right paw", -14},
                            {"hind left upper", 28},
                            {"hind left lower", 2},
                            {"hind left cannon", 8},
                            {"hind left paw", -10},
                            {"hind right upper", -25},
                            {"hind right lower", 14},
                            {"hind right cannon", -10}};

// Half way from a stride to its mirror image: one front leg and the other hind leg swing.
constexpr Turn kPass[] = {{"neck", 4},
                          {"nape", 4},
                          {"head", -4},
                          {"tail root", 26},
                          {"tail", 10},
                          {"tail tip", 16},
                          {"front left upper", -4},
                          {"front right upper", -26},
                          {"front right lower", 52},
                          {"front right cannon", 24},
                          {"front right paw", 16},
                          {"hind left upper", -16},
                          {"hind left lower", 40},
                          {"hind left cannon", -36},
                          {"hind left paw", 20},
                          {"hind right upper", 2},
                          {"hind right lower", 4}};

constexpr Turn kSit[] = {{"pelvis", -46},
                         {"loin", 4},
                         {"chest", 4},
                         {"neck", 14},
                         {"nape", 14},
                         {"head", 10},
                         {"tail root", 16},
                         {"tail", -24},
                         {"tail tip", -24},
                         {"front left upper", 42},
                         {"front left lower", -6},
                         {"front left cannon", 2},
                         {"front right upper", 42},
                         {"front right lower", -6},
                         {"front right cannon", 2},
                         {"hind left upper", -42, 16},
                         {"hind left lower", 80},
                         {"hind left cannon", -58},
                         {"hind left paw", 54},
                         {"hind right upper", -42, -16},
                         {"hind right lower", 80},
                         {"hind right cannon", -58},
                         {"hind right paw", 54}};

constexpr Turn kStretch[] = {{"pelvis", 25},
                             {"loin", 6},
                             {"chest", -4},
                             {"neck", -14},
                             {"nape", -16},
                             {"head", -10},
                             {"tail root", 50},
                             {"tail", 34},
                             {"tail tip", 24},
                             {"front left upper", -74},
                             {"front left lower", -14},
                             {"front left paw", 50},
                             {"front right upper", -74},
                             {"front right lower", -14},
                             {"front right paw", 50},
                             {"hind left upper", -4},
                             {"hind left lower", -20},
                             {"hind right upper", -4},
                             {"hind right lower", -20}};

constexpr Turn kRear[] = {{"pelvis", -52},
                          {"loin", -6},
                          {"chest", -4},
                          {"neck", 14},
                          {"nape", 18},
                          {"head", 16},
                          {"tail root", 20},
                          {"front left upper", -30},
                          {"front left lower", 70},
                          {"front left cannon", 30},
                          {"front left paw", 20},
                          {"front right upper", -5},
                          {"front right lower", 60},
                          {"front right cannon", 30},
                          {"front right paw", 20},
                          {"hind left upper", 30},
                          {"hind left lower", 34},
                          {"hind left cannon", -20},
                          {"hind right upper", 20},
                          {"hind right lower", 38},
                          {"hind right cannon", -18}};

/// The angles that a joint may have in a random pose: pitch between two limits, yaw and roll up to
/// a limit to either side. They reach about as far as the poses above.
struct TurnRange {
  const char* bone;
  double least_pitch, greatest_pitch, yaw = 0, roll = 0;
};

constexpr TurnRange kRandomTurns[] = {{"pelvis", -50, 25},
                                      {"loin", -8, 8, 10, 6},
                                      {"chest", -8, 8, 10, 6},
                                      {"neck", -18, 18, 14, 5},
                                      {"nape", -18, 20, 16, 5},
                                      {"head", -12, 18, 20, 12},
                                      {"left ear", -20, 20, 0, 20},
                                      {"right ear", -20, 20, 0, 20},
                                      {"tail root", -10, 50, 20},
                                      {"tail", -30, 40, 25},
                                      {"tail tip", -30, 30, 25},
                                      {"front left upper", -74, 42, 6},
                                      {"front left lower", -14, 70},
                                      {"front left cannon", 0, 30},
                                      {"front left paw", -14, 50},
                                      {"front right upper", -74, 42, 6},
                                      {"front right lower", -14, 70},
                                      {"front right cannon", 0, 30},
                                      {"front right paw", -14, 50},
                                      {"hind left upper", -42, 30, 12},
                                      {"hind left lower", -20, 80},
                                      {"hind left cannon", -58, 10},
                                      {"hind left paw", -10, 54},
                                      {"hind right upper", -42, 30, 12},
                                      {"hind right lower", -20, 80},
                                      {"hind right cannon", -58, 10},
                                      {"hind right paw", -10, 54}};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BODIES_DETAIL_QUADRUPED_POSES_H_
