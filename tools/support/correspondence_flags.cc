#include "support/correspondence_flags.h"

#include "support/tool.h"

DEFINE_string(markers, "",
              "text file of vertices that belong together: a vertex of the template (the source) "
              "and one of the target a line, by number from 1 or by the name of a group");
DEFINE_bool(hold_all_markers, false,
            "hold markers that contradict the others, too, in place of leaving them out");
DEFINE_double(proportions, shapespace::CorrespondenceOptions().proportions,
              "over which length, as a share of the root of the area, the bodies' proportions may "
              "differ from place to place");

namespace shapespace::tools {

CorrespondenceOptions CorrespondenceFromFlags() {
  CorrespondenceOptions options;
  options.drop_doubtful = !FLAGS_hold_all_markers;
  options.proportions = FLAGS_proportions;
  NamingFlags({}, [&] { options.Validate(); });
  return options;
}

}  // namespace shapespace::tools
