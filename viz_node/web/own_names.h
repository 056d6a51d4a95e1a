// viz_node/web/own_names.h -- the names of this machine, as others write them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace cordis::viz {

/// The names of a machine with this host name: the name itself, its first part, and that with
/// ".local", as mDNS has it.
std::vector<std::string> names_of_host(std::string_view host_name);

/// The name of this machine: gethostname(), "localhost" when there is none.
std::string own_host_name();

/// names_of_host() of this machine, and the full name that its resolver knows. May wait for the
/// resolver.
std::vector<std::string> own_names();

}  // namespace cordis::viz
