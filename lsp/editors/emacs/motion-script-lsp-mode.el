;; Emacs with lsp-mode: in init.el.
(require 'project)
(defun motion-script-project (folder)
  "Return the project of FOLDER: the nearest that has an mlmg.toml."
  (let ((root (locate-dominating-file folder "mlmg.toml")))
    (and root (cons 'transient root))))
(define-derived-mode motion-script-mode prog-mode "Motion Script"
  (add-hook 'project-find-functions #'motion-script-project nil t)
  (setq-local comment-start "# ")
  (setq-local comment-start-skip "#+\\s-*"))
(add-to-list 'auto-mode-alist '("\\.ms\\'" . motion-script-mode))
(with-eval-after-load 'lsp-mode
  (add-to-list 'lsp-language-id-configuration '(motion-script-mode . "motion-script"))
  (lsp-register-client
   (make-lsp-client :new-connection (lsp-stdio-connection
                                     '("mlmg" "lsp" "--stdio" "--position-encoding" "utf-32"))
                    :activation-fn (lsp-activate-on "motion-script")
                    :server-id 'mlmg)))
(add-hook 'motion-script-mode-hook #'lsp-deferred)
