// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// The page's own questions, and lines that say what happened.
const $ = (id) => document.getElementById(id);

/// Asks a question; resolves to whether the answer was yes.
export function question(text, yes, no) {
  const dialog = $("question");
  $("question-text").textContent = text;
  $("question-yes").textContent = yes;
  $("question-no").textContent = no;
  dialog.showModal();
  return new Promise((done) => {
    const answer = (is_yes) => { dialog.onclose = null; dialog.close(); done(is_yes); };
    $("question-yes").onclick = () => answer(true);
    $("question-no").onclick = () => answer(false);
    dialog.onclose = () => done(false);  // Escape
  });
}

let since = 0;
/// Shows a line for some seconds.
export function tell(text) {
  $("said").textContent = text;
  $("said").hidden = false;
  clearTimeout(since);
  since = setTimeout(() => { $("said").hidden = true; }, 6000);
}
