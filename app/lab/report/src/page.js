"use strict";

/** Copies a table as CSV, and says so on the button. */
function copyRows(button, rows) {
  const cell = value => /[",\n]/.test(value) ? `"${String(value).replaceAll('"', '""')}"` : value;
  const text = rows.map(row => row.map(cell).join(",")).join("\n") + "\n";
  const done = () => {
    button.textContent = "copied";
    setTimeout(() => { button.textContent = "CSV"; }, 1500);
  };
  // Where the clipboard is closed to pages, a selected text can be copied all the same.
  const select = () => {
    const area = document.body.appendChild(document.createElement("textarea"));
    area.value = text;
    area.select();
    if (document.execCommand("copy")) done();
    area.remove();
  };
  if (navigator.clipboard) navigator.clipboard.writeText(text).then(done, select);
  else select();
}

for (const table of document.querySelectorAll("table")) {
  const button = table.querySelector(".copy");
  const cells = row => [...row.cells].flatMap(cell => [cell.textContent, ...Array(cell.colSpan - 1).fill("")]);
  button.addEventListener("click", () => copyRows(button, [...table.rows].map(cells)));
}

for (const figure of document.querySelectorAll("figure")) {
  const data = JSON.parse(figure.querySelector("script").textContent);
  const svg = figure.querySelector(".drawing svg");
  const output = figure.querySelector("output");
  const hidden = new Set();
  const ring = document.createElementNS("http://www.w3.org/2000/svg", "circle");
  ring.setAttribute("class", "at");
  ring.setAttribute("r", 15);
  const leave = () => {
    output.hidden = true;
    ring.remove();
  };

  figure.querySelectorAll(".legend button").forEach((button, series) => button.addEventListener("click", () => {
    const isShown = !hidden.delete(series);
    if (isShown) hidden.add(series);
    button.setAttribute("aria-pressed", !isShown);
    svg.querySelector(`g[data-series="${series}"]`).classList.toggle("off", isShown);
    leave();
  }));

  const number = value => String(Number(value.toPrecision(5)));
  const describe = point => {
    const interval = point.interval ? ` (${point.interval.map(number).join(" to ")})` : "";
    if (data.rows.length) return `${data.rows[point.y]}, ${data.series[point.series]}\n${number(point.x)}${interval}  ${data.x}`;
    return `${data.series[point.series]}\n${number(point.y)}  ${data.y}\n${number(point.x)}  ${data.x}`;
  };
  const point = event => {
    const box = svg.getBoundingClientRect();
    const scale = svg.viewBox.baseVal.width / box.width;
    const [x, y] = [(event.clientX - box.left) * scale, (event.clientY - box.top) * scale];
    const distance = point => Math.hypot(point.at[0] - x, point.at[1] - y);
    const shown = data.points.filter(point => !hidden.has(point.series));
    const nearest = shown.reduce((a, b) => a && distance(a) <= distance(b) ? a : b, null);
    if (!nearest || distance(nearest) > 80) return leave();
    output.textContent = describe(nearest);
    output.hidden = false;
    ring.setAttribute("cx", nearest.at[0]);
    ring.setAttribute("cy", nearest.at[1]);
    svg.append(ring);
    const [left, top] = nearest.at.map(at => at / scale);
    output.style.left = `${Math.max(0, Math.min(left + 12, box.width - output.offsetWidth))}px`;
    output.style.top = `${top - output.offsetHeight - 12}px`;
  };
  svg.addEventListener("pointermove", point);
  svg.addEventListener("pointerdown", point);
  svg.addEventListener("pointerleave", leave);

  const button = figure.querySelector(".copy");
  button.addEventListener("click", () => {
    const intervals = data.points.some(point => point.interval);
    const head = ["series", ...data.rows.length ? ["row", data.x] : [data.x, data.y], ...intervals ? ["low", "high"] : []];
    const row = point => [
      data.series[point.series],
      ...data.rows.length ? [data.rows[point.y], point.x] : [point.x, point.y],
      ...intervals ? point.interval ?? ["", ""] : [],
    ];
    copyRows(button, [head, ...data.points.map(row)]);
  });
}

for (const viewer of document.querySelectorAll(".viewer")) {
  const stage = viewer.querySelector(".stage");
  const images = [...viewer.querySelectorAll(".stack img")];
  const buttons = [...viewer.querySelectorAll(".view")];
  const stereo = viewer.querySelector(".stereo");
  const caption = viewer.querySelector(".caption");
  let current = 0, previous = Math.min(1, images.length - 1);

  const show = index => {
    if (index < 0 || index >= images.length) return;
    if (index !== current) previous = current;
    current = index;
    images.forEach((image, i) => image.classList.toggle("on", i === index));
    buttons.forEach((button, i) => button.setAttribute("aria-pressed", i === index));
    caption.textContent = images[index].dataset.caption;
  };
  const toggleStereo = () => {
    if (!stereo) return;
    const on = stage.classList.toggle("stereo");
    stage.classList.remove("zoom");
    stereo.setAttribute("aria-pressed", on);
    if (on && !stage.querySelector(".other")) {
      const other = new Image();
      other.className = "other";
      other.alt = "the other eye";
      other.src = images[stage.dataset.other].src;
      stage.append(other);
    }
  };
  buttons.forEach((button, index) => button.addEventListener("click", () => show(index)));
  stereo?.addEventListener("click", toggleStereo);
  stage.addEventListener("click", event => {
    if (stage.classList.contains("stereo")) return;
    const box = images[current].getBoundingClientRect();
    const [u, v] = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    // One pixel of the picture on one of the screen.
    const isZoomed = stage.classList.toggle("zoom");
    stage.style.setProperty("--natural", stage.dataset.width / (isZoomed ? window.devicePixelRatio : 1) + "px");
    if (isZoomed) {
      const zoomed = images[current].getBoundingClientRect();
      stage.scrollTo(u * zoomed.width - stage.clientWidth / 2, v * zoomed.height - stage.clientHeight / 2);
    }
  });
  viewer.press = key => {
    if (key >= "1" && key <= "9") show(Number(key) - 1);
    else if (key === "f") show(previous);
    else if (key === "s") toggleStereo();
  };
  show(0);
}

document.addEventListener("keydown", event => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.key.length !== 1) return;
  const middle = window.innerHeight / 2;
  const distance = viewer => {
    const box = viewer.querySelector(".stage").getBoundingClientRect();
    return Math.max(box.top - middle, middle - box.bottom);
  };
  const viewers = [...document.querySelectorAll(".viewer")];
  if (viewers.length) viewers.reduce((a, b) => distance(b) < distance(a) ? b : a).press(event.key);
});

window.addEventListener("beforeprint", () => {
  document.querySelectorAll("details").forEach(details => { details.open = true; });
});
