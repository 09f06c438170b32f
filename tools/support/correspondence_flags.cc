#include "support/correspondence_flags.h"

#include <shapespace/correspondence/internal/option_fields.h>

#include "support/flag_group.h"
#include "support/memory_flag.h"
#include "support/option_flags.h"

DEFINE_string(markers, "",
              "text file of corresponding vertices: in each line a vertex of the template (the "
              "source) and one of the target, by number from 1 or by the name of a group");
DEFINE_bool(hold_all_markers, false, "use all markers, including those that contradict the others");
static const shapespace::tools::OptionFlags<shapespace::CorrespondenceOptions> flags(
    __FILE__, {{"proportions", "proportions"}});
FLAG_GROUP(correspondence, "Correspondence");

namespace shapespace::tools {

CorrespondenceOptions CorrespondenceFromFlags() {
  CorrespondenceOptions options;
  options.drop_doubtful = !FLAGS_hold_all_markers;
  options.memory_limit = 1e9 * FLAGS_memory_limit;
  flags.Set(&options);
  return options;
}

}  // namespace shapespace::tools
