// sim_node/engine/pairs/contact_forces.cpp
#include "sim_node/engine/pairs/contact_forces.h"

#include <algorithm>
#include <span>
#include <utility>

namespace cordis::engine {

ContactForces::ContactForces(const NetworkDescription& description, const SetLiaison& set) {
  const std::size_t member_count = set.set_p.size() + set.set_q.size();
  if (description.contacts.empty()) return;
  std::vector<Side> side_of_mat(description.mats.size(), Side::kNone);
  const auto put = [&](std::uint32_t group, Side side) {
    for (const std::uint32_t mat : description.groups[group].members) side_of_mat[mat] = side;
  };
  for (std::uint32_t c = 0; c < description.contacts.size(); ++c) {
    const ContactOfGroups& groups = description.contacts[c];
    put(groups.on, Side::kOn);
    put(groups.by, Side::kBy);
    Contact contact{c, {}, Vec3::Zero()};
    for (const auto* half : {&set.set_p, &set.set_q}) {
      for (const std::uint32_t mat : *half) contact.side.push_back(side_of_mat[mat]);
    }
    put(groups.on, Side::kNone);
    put(groups.by, Side::kNone);
    const auto has = [&contact](Side side) { return std::ranges::count(contact.side, side) > 0; };
    if (has(Side::kOn) && has(Side::kBy)) contacts_.push_back(std::move(contact));
  }
  if (contacts_.empty()) return;
  asked_for_.resize(member_count, 0);
  for (const Contact& contact : contacts_) {
    for (std::size_t m = 0; m < member_count; ++m) {
      if (contact.side[m] != Side::kNone) asked_for_[m] = 1;
    }
  }
}

void ContactForces::begin_step() noexcept {
  for (Contact& contact : contacts_) contact.force.setZero();
}

void ContactForces::add(const PairRows& rows, const double* factor,
                        const FrictionRows* friction) noexcept {
  const PairRow& pair = rows.pairs;
  for (Contact& contact : contacts_) {
    for (std::size_t i = 0; i < rows.count; ++i) {
      const Side a = contact.side[rows.column_a[i] / 4];
      const Side b = contact.side[pair.column[i] / 4];
      if (a == b || a == Side::kNone || b == Side::kNone) continue;
      Vec3 on_a(pair.x[i] * factor[i], pair.y[i] * factor[i], pair.z[i] * factor[i]);
      if (friction != nullptr) {
        on_a += Vec3(friction->force[0][i], friction->force[1][i], friction->force[2][i]);
      }
      contact.force += a == Side::kOn ? on_a : Vec3(-on_a);
    }
  }
}

Vec3 ContactForces::force(std::uint32_t contact) const noexcept {
  const auto known = std::ranges::find(contacts_, contact, &Contact::index);
  return known == contacts_.end() ? Vec3(Vec3::Zero()) : known->force;
}

void ContactForces::serialize(Archive& archive) {
  for (Contact& contact : contacts_) archive.reals(std::span<double>(contact.force.data(), 3));
}

}  // namespace cordis::engine
