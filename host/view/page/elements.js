// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
/// Returns a new element with these properties and children.
export function make(name, properties, ...children) {
  const out = Object.assign(document.createElement(name), properties);
  out.append(...children);
  return out;
}
