#pragma once

#include <string>

#include "pipeline/procedure/procedure.h"
#include "pipeline/record/record_check.h"

namespace pleinair::record {

/// A record as a page that prints well (A4): head, verdict, every step with its times, values and
/// stills. HTML 5 without scripts; it refers to the stills, so it belongs beside the record.
/// `procedure` gives titles in the record's language, if it is there and the record's version of
/// it.
std::string htmlReport(const RecordReading& reading, const procedure::Procedure* procedure);

}  // namespace pleinair::record
