// Slices of the averaged fields.
addSection({ id: "averages", title: "Averaged fields", make: ({ runs }) => gallery(runs, "averages") });
