// Shows the tiles of the arm that is chosen.
(() => {
  const select = document.querySelector("#tiles select");
  if (!select) return;

  const show = () => {
    for (const map of document.querySelectorAll("#tiles figure")) map.hidden = map.dataset.arm !== select.value;
  };

  select.addEventListener("change", show);
  // A browser may have kept the choice of an earlier visit.
  show();
})();
