#include "support/correspondence_flags.h"

#include "support/flag_group.h"
#include "support/memory_flag.h"
#include "support/tool.h"

DEFINE_string(markers, "",
              "text file of corresponding vertices: in each line a vertex of the template (the "
              "source) and one of the target, by number from 1 or by the name of a group");
DEFINE_bool(hold_all_markers, false, "use all markers, including those that contradict the others");
DEFINE_double(proportions, shapespace::CorrespondenceOptions().proportions,
              "length over which the ratio of the bodies' proportions may change, as a share of "
              "the square root of the area");
FLAG_GROUP(correspondence, "Correspondence");

namespace shapespace::tools {

CorrespondenceOptions CorrespondenceFromFlags() {
  CorrespondenceOptions options;
  options.drop_doubtful = !FLAGS_hold_all_markers;
  options.proportions = FLAGS_proportions;
  options.memory_limit = 1e9 * FLAGS_memory_limit;
  NamingFlags({}, [&] { options.Validate(); });
  return options;
}

}  // namespace shapespace::tools
