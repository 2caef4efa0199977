"use strict";
const layers = [...document.querySelectorAll("[data-layer]")];
const show = (box) => document.body.classList.toggle("no-" + box.dataset.layer, !box.checked);
layers.forEach((box) => { box.addEventListener("change", () => show(box)); show(box); });
document.getElementById("size").addEventListener("input", (event) =>
  document.documentElement.style.setProperty("--size", event.target.value + "px"));
document.addEventListener("keydown", (event) => {
  if (event.target.isContentEditable || event.ctrlKey || event.metaKey || event.altKey) return;
  const box = /^[0-9]$/.test(event.key) ? layers[(Number(event.key) + 9) % 10] : undefined;
  if (box) { box.checked = !box.checked; show(box); }
});
const typed = document.getElementById("typed");
typed.addEventListener("input", () => document.querySelectorAll("#waterfall span").forEach((span) => {
  span.textContent = typed.textContent;
  span.parentElement.dir = "auto";
}));
document.querySelector("main").addEventListener("click", (event) => {
  const figure = event.target.closest("figure");
  if (figure) { figure.classList.toggle("large"); figure.scrollIntoView({ block: "nearest" }); }
});
const main = document.querySelector("main");
const onPage = [...main.children];
const orders = {
  page: () => 0,
  worst: (a, b) => b.dataset.worst - a.dataset.worst,
  changed: (a, b) => b.dataset.changed - a.dataset.changed,
  name: (a, b) => a.dataset.name.localeCompare(b.dataset.name, "en"),
};
document.getElementById("order").addEventListener("change", (event) =>
  main.append(...[...onPage].sort(orders[event.target.value])));
