// Two pictures, one over the other: a divider that is dragged or moved by arrow keys, and one zoom for both.
(() => {
  const section = document.getElementById("compare");
  if (!section) return;
  const stage = section.querySelector(".stage");
  const divider = section.querySelector(".divider");
  const differences = section.querySelector("[name=differences]");
  const view = { split: 50, zoom: 1, x: 0, y: 0 };
  const clamp = (value, low, high) => Math.min(high, Math.max(low, value));

  // One transform for both layers: they cannot be out of step.
  const draw = () => {
    const { width, height } = stage.getBoundingClientRect();
    view.x = clamp(view.x, (1 - view.zoom) * width, 0);
    view.y = clamp(view.y, (1 - view.zoom) * height, 0);
    stage.style.setProperty("--split", `${view.split}%`);
    stage.style.setProperty("--zoom", view.zoom);
    stage.style.setProperty("--x", `${view.x}px`);
    stage.style.setProperty("--y", `${view.y}px`);
    stage.classList.toggle("enlarged", view.zoom > 1);
    divider.ariaValueNow = Math.round(view.split);
  };

  const show = (side) => {
    const chosen = document.getElementById(section.querySelector(`select[name=${side}]`).value);
    const difference = differences?.checked && chosen.querySelector(".difference");
    const shown = difference || chosen.querySelector(".picture");
    const image = stage.querySelector(`.layer.${side} img`);
    image.src = shown.src;
    image.alt = shown.alt;
    stage.querySelector(`.caption.${side}`).textContent = (difference ? "difference: " : "") + chosen.querySelector("b").textContent;
    return shown;
  };

  const choose = () => {
    const left = show("left");
    const right = show("right");
    stage.style.setProperty("--aspect", `${left.getAttribute("width")} / ${left.getAttribute("height")}`);
    stage.style.setProperty("--natural", `${Math.max(640, ...[left, right].map((image) => Number(image.getAttribute("width"))))}px`);
    section.querySelector(".scale-note").hidden = !differences?.checked;
    draw();
  };

  // What is in the middle stays there.
  const enlarge = (zoom) => {
    const { width, height } = stage.getBoundingClientRect();
    const middle = [width / 2, height / 2];
    view.x = middle[0] - ((middle[0] - view.x) / view.zoom) * zoom;
    view.y = middle[1] - ((middle[1] - view.y) / view.zoom) * zoom;
    view.zoom = zoom;
    section.querySelector(`[name=zoom][value="${zoom}"]`).checked = true;
    draw();
  };

  const move = (x, y) => {
    view.x += x;
    view.y += y;
    draw();
  };

  const divide = (split) => {
    view.split = clamp(split, 0, 100);
    draw();
  };

  const drag = (element, moved) => {
    let last;
    element.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || (element === stage && event.target === divider)) return;
      last = event;
      element.setPointerCapture(event.pointerId);
    });
    element.addEventListener("pointermove", (event) => {
      if (!last) return;
      moved(event, last);
      last = event;
    });
    for (const end of ["pointerup", "pointercancel"]) element.addEventListener(end, () => (last = undefined));
  };

  const keys = (element, actions) => {
    element.addEventListener("keydown", (event) => {
      const action = event.target === element && !event.ctrlKey && !event.metaKey && actions[event.key];
      if (!action) return;
      event.preventDefault();
      action(event.shiftKey ? 4 : 1);
    });
  };

  drag(divider, (event) => {
    const { left, width } = stage.getBoundingClientRect();
    divide((100 * (event.clientX - left)) / width);
  });
  drag(stage, (event, last) => move(event.clientX - last.clientX, event.clientY - last.clientY));

  const zooms = Object.fromEntries([1, 2, 4, 8].map((zoom) => [zoom, () => enlarge(zoom)]));
  keys(divider, {
    ...zooms,
    ArrowLeft: (times) => divide(view.split - 2 * times),
    ArrowRight: (times) => divide(view.split + 2 * times),
    Home: () => divide(0),
    End: () => divide(100),
  });
  keys(stage, {
    ...zooms,
    ArrowLeft: (times) => move(24 * times, 0),
    ArrowRight: (times) => move(-24 * times, 0),
    ArrowUp: (times) => move(0, 24 * times),
    ArrowDown: (times) => move(0, -24 * times),
  });

  for (const input of section.querySelectorAll("[name=zoom]")) {
    input.addEventListener("change", () => enlarge(Number(input.value)));
  }
  for (const input of section.querySelectorAll("select, [name=differences]")) input.addEventListener("change", choose);
  new ResizeObserver(draw).observe(stage);
  choose();
})();
