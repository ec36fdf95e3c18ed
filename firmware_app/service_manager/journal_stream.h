#pragma once

namespace pleinair::app {

/// Whether a descriptor is the stream to the journal that a service manager connected
/// ($JOURNAL_STREAM holds its device and inode): lines may then begin with "<3>", a level of
/// syslog(3), which the journal takes off and files the line under (sd-daemon(3)).
bool isJournalStream(int descriptor);

}  // namespace pleinair::app
