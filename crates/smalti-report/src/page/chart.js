// The arm that is pointed at tells its settings and command, as its row in the table has them.
(() => {
  document.documentElement.classList.add("js");
  const about = document.getElementById("about");
  if (!about) return;

  const tell = (arm) => {
    const row = document.getElementById(`arm-${arm}`);
    const told = row.querySelector(".about").cloneNode(true);
    const name = document.createElement("strong");
    name.textContent = row.querySelector(".label").textContent;
    told.prepend(name);
    about.replaceChildren(told);
    for (const part of document.querySelectorAll(".told")) part.classList.remove("told");
    for (const part of document.querySelectorAll(`[data-arm="${arm}"]`)) part.classList.add("told");
  };

  for (const point of document.querySelectorAll("#chart .arm")) {
    for (const event of ["pointerenter", "focus", "click"]) {
      point.addEventListener(event, () => tell(point.dataset.arm));
    }
  }
})();
